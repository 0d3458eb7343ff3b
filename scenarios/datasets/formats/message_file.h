// Files of messages: ROS 1 bags and MCAP files with ROS 2 messages. Both are read and written through one interface.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// Writes beside the final name; the file appears under it with finish() only. Not thread-safe.
class MessageWriter {
 public:
  virtual ~MessageWriter() = default;
  /// In order of Message::recorded, which must be > 0. `latched`: late subscribers get it too (static transforms).
  /// Throws ResourceError.
  virtual void write(const Message& message, bool latched = false) = 0;
  virtual void finish() = 0;
};
/// ROS 1 bag, format 2.0, chunks compressed with LZ4.
std::unique_ptr<MessageWriter> write_bag(const std::filesystem::path& path);
/// MCAP, profile ros2, CDR messages, chunks compressed with zstd, with indexes and CRCs.
std::unique_ptr<MessageWriter> write_mcap(const std::filesystem::path& path);

struct RecordedTopic {
  std::string name;
  std::string type;  ///< ROS 1's spelling: sensor_msgs/PointCloud2
  uint64_t messages = 0;
};

struct ReadOptions {
  std::vector<std::string> topics{};  ///< only these; empty: all
  bool salvage = false;               ///< of a broken or truncated file, read what is before the break
  /// Chunks that overlap in time stay decompressed up to so much; what was let go is read again.
  size_t chunk_memory_bytes = size_t{256} << 20;
  bool headers_only = false;  ///< of a message's content only the header is filled
};

/// Reads in order of recording, in bounded memory. Not thread-safe.
class MessageReader {
 public:
  virtual ~MessageReader() = default;
  virtual const std::vector<RecordedTopic>& topics() const = 0;  ///< sorted by name, of all types
  /// First and last recording time; equal and 0 for an empty file.
  virtual Time begin() const = 0;
  virtual Time end() const = 0;
  /// The next message of a type that MessageContent has; others are passed over. nullopt: the end. Throws InputError
  /// with the file's name and what is broken and where, unless salvage is asked for.
  virtual std::optional<Message> next() = 0;
  /// What broke, after a salvage; empty: nothing.
  virtual const std::string& damage() const = 0;
};
/// By content, not by the name's ending. Throws InputError.
std::unique_ptr<MessageReader> read_messages(const std::filesystem::path& path,
                                             const ReadOptions& options = {});

}  // namespace vsslam

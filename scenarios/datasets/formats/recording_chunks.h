// What bags and MCAP files have in common: messages lie in chunks, each compressed by itself, and an index at the end says
// which times a chunk covers.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"
#include "scenarios/datasets/formats/byte_file.h"
#include "scenarios/datasets/messages/wire_format.h"

namespace vsslam {

/// ROS 1 says connection, MCAP channel. Several may share a topic.
struct RecordedConnection {
  std::string topic;
  std::string type;                    ///< ROS 1's spelling
  std::optional<WireFormat> format{};  ///< nullopt: in no encoding that is read here
};

struct RecordedChunk {
  uint64_t offset = 0, size = 0;  ///< in the file, bytes
  Time begin{}, end{};
  std::optional<std::vector<uint32_t>> connections{};  ///< that it has messages of; nullopt: not known
};

/// A chunk's records, decompressed.
struct ChunkContent {
  struct Message {
    Time recorded;
    uint32_t connection = 0;
    size_t offset = 0, size = 0;  ///< of its content in `bytes`
  };
  std::string bytes;
  std::vector<Message> messages;  ///< in the order of the file
  std::string damage;             ///< what broke after them, and where in the file; empty: nothing
};

struct RecordingIndex {
  std::map<uint32_t, RecordedConnection> connections;
  std::map<uint32_t, uint64_t> messages;  ///< of a connection
  std::vector<RecordedChunk> chunks;      ///< in the order of the file; those without messages left out
  std::string damage;                     ///< where the file breaks off; empty: nowhere
};

/// One file. Errors and damage do not name it.
class ChunkedRecording {
 public:
  explicit ChunkedRecording(const std::filesystem::path& path) : file_(path) {}
  virtual ~ChunkedRecording() = default;
  const std::string& name() const { return file_.name(); }
  /// By the file's own index where it has one. Throws InputError if the file is broken or unfinished.
  virtual RecordingIndex index() = 0;
  /// By a walk through the whole file up to where it breaks.
  virtual RecordingIndex scan() = 0;
  virtual ChunkContent load(const RecordedChunk& chunk) = 0;

 protected:
  /// Adds the chunk with its times and messages, if it has any.
  static void count(RecordedChunk chunk, const ChunkContent& content, RecordingIndex& index);

  ByteFile file_;
};

/// How the files begin; 13 and 8 bytes.
inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

std::unique_ptr<ChunkedRecording> open_bag(const std::filesystem::path& path);
std::unique_ptr<ChunkedRecording> open_mcap(const std::filesystem::path& path);

/// Chunks that announce more than this are taken for broken.
inline constexpr uint64_t kMaxChunkBytes = uint64_t{1} << 32;

}  // namespace vsslam

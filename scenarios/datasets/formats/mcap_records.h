// The records of MCAP files (https://mcap.dev/spec): an opcode, a length of 8 bytes, and the content.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "scenarios/datasets/messages/byte_cursor.h"

namespace vsslam {

enum class McapOp : uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

inline constexpr size_t kMcapRecordHeader = 9, kMcapFooter = 20;  // bytes

struct McapRecord {
  McapOp op;
  std::string_view content;

  explicit McapRecord(ByteCursor& cursor)
      : op(static_cast<McapOp>(cursor.number<uint8_t>())), content(cursor.counted<uint64_t>()) {}
};

struct McapSchema {
  uint16_t id = 0;
  std::string name, encoding, definition;
};

struct McapChannel {
  uint16_t id = 0, schema = 0;
  std::string topic, encoding;
  std::map<std::string, std::string> metadata{};
};

struct McapChunkIndex {
  uint64_t begin_ns = 0, end_ns = 0, offset = 0, size = 0;
  std::map<uint16_t, uint64_t> message_indexes{};  ///< their places by channel
  uint64_t message_indexes_size = 0;
  std::string compression;
  uint64_t compressed_size = 0, uncompressed_size = 0;
};

struct McapStatistics {
  uint64_t messages = 0;
  uint16_t schemas = 0;
  uint32_t channels = 0, attachments = 0, metadata = 0, chunks = 0;
  uint64_t begin_ns = 0, end_ns = 0;
  std::map<uint16_t, uint64_t> channel_messages{};
};

/// Appends a whole record.
void put_record(McapOp op, std::string_view content, std::string& bytes);
void put_text(std::string_view text, std::string& bytes);

std::string mcap_content(const McapSchema& schema);
std::string mcap_content(const McapChannel& channel);
std::string mcap_content(const McapChunkIndex& chunk);
std::string mcap_content(const McapStatistics& statistics);

/// From a record's content. Throw InputError.
McapSchema mcap_schema(std::string_view content);
McapChannel mcap_channel(std::string_view content);
McapChunkIndex mcap_chunk_index(std::string_view content);
McapStatistics mcap_statistics(std::string_view content);

/// CRC-32 as zlib has it.
uint32_t crc32_of(std::string_view bytes);

}  // namespace vsslam

#include "scenarios/datasets/formats/mcap_records.h"

#include <zlib.h>

namespace vsslam {

namespace {

/// Pairs of fixed size after their length in bytes.
void put_map(const std::map<uint16_t, uint64_t>& values, std::string& bytes) {
  put_number(bytes, static_cast<uint32_t>(values.size() * (sizeof(uint16_t) + sizeof(uint64_t))));
  for (const auto& [key, value] : values) {
    put_number(bytes, key);
    put_number(bytes, value);
  }
}

std::map<uint16_t, uint64_t> map_from(ByteCursor& cursor) {
  std::map<uint16_t, uint64_t> values;
  for (ByteCursor pairs(cursor.counted<uint32_t>()); pairs.left() > 0;) {
    const auto key = pairs.number<uint16_t>();
    values[key] = pairs.number<uint64_t>();
  }
  return values;
}

std::string text_from(ByteCursor& cursor) {
  return std::string(cursor.counted<uint32_t>());
}

}  // namespace

void put_record(McapOp op, std::string_view content, std::string& bytes) {
  put_number(bytes, static_cast<uint8_t>(op));
  put_number(bytes, uint64_t{content.size()});
  bytes += content;
}

void put_text(std::string_view text, std::string& bytes) {
  put_number(bytes, static_cast<uint32_t>(text.size()));
  bytes += text;
}

std::string mcap_content(const McapSchema& schema) {
  std::string bytes;
  put_number(bytes, schema.id);
  put_text(schema.name, bytes);
  put_text(schema.encoding, bytes);
  put_text(schema.definition, bytes);
  return bytes;
}

McapSchema mcap_schema(std::string_view content) {
  ByteCursor cursor(content);
  McapSchema schema{cursor.number<uint16_t>(), {}, {}, {}};
  schema.name = text_from(cursor);
  schema.encoding = text_from(cursor);
  schema.definition = text_from(cursor);
  return schema;
}

std::string mcap_content(const McapChannel& channel) {
  std::string bytes, metadata;
  for (const auto& [key, value] : channel.metadata) {
    put_text(key, metadata);
    put_text(value, metadata);
  }
  put_number(bytes, channel.id);
  put_number(bytes, channel.schema);
  put_text(channel.topic, bytes);
  put_text(channel.encoding, bytes);
  put_text(metadata, bytes);
  return bytes;
}

McapChannel mcap_channel(std::string_view content) {
  ByteCursor cursor(content);
  McapChannel channel;
  channel.id = cursor.number<uint16_t>();
  channel.schema = cursor.number<uint16_t>();
  channel.topic = text_from(cursor);
  channel.encoding = text_from(cursor);
  for (ByteCursor pairs(cursor.counted<uint32_t>()); pairs.left() > 0;) {
    std::string key = text_from(pairs);
    channel.metadata[std::move(key)] = text_from(pairs);
  }
  return channel;
}

std::string mcap_content(const McapChunkIndex& chunk) {
  std::string bytes;
  for (const uint64_t value : {chunk.begin_ns, chunk.end_ns, chunk.offset, chunk.size})
    put_number(bytes, value);
  put_map(chunk.message_indexes, bytes);
  put_number(bytes, chunk.message_indexes_size);
  put_text(chunk.compression, bytes);
  put_number(bytes, chunk.compressed_size);
  put_number(bytes, chunk.uncompressed_size);
  return bytes;
}

McapChunkIndex mcap_chunk_index(std::string_view content) {
  ByteCursor cursor(content);
  McapChunkIndex chunk;
  for (uint64_t* value : {&chunk.begin_ns, &chunk.end_ns, &chunk.offset, &chunk.size})
    *value = cursor.number<uint64_t>();
  chunk.message_indexes = map_from(cursor);
  chunk.message_indexes_size = cursor.number<uint64_t>();
  chunk.compression = text_from(cursor);
  chunk.compressed_size = cursor.number<uint64_t>();
  chunk.uncompressed_size = cursor.number<uint64_t>();
  return chunk;
}

std::string mcap_content(const McapStatistics& s) {
  std::string bytes;
  put_number(bytes, s.messages);
  put_number(bytes, s.schemas);
  for (const uint32_t value : {s.channels, s.attachments, s.metadata, s.chunks}) put_number(bytes, value);
  put_number(bytes, s.begin_ns);
  put_number(bytes, s.end_ns);
  put_map(s.channel_messages, bytes);
  return bytes;
}

McapStatistics mcap_statistics(std::string_view content) {
  ByteCursor cursor(content);
  McapStatistics s;
  s.messages = cursor.number<uint64_t>();
  s.schemas = cursor.number<uint16_t>();
  for (uint32_t* value : {&s.channels, &s.attachments, &s.metadata, &s.chunks})
    *value = cursor.number<uint32_t>();
  s.begin_ns = cursor.number<uint64_t>();
  s.end_ns = cursor.number<uint64_t>();
  s.channel_messages = map_from(cursor);
  return s;
}

uint32_t crc32_of(std::string_view bytes) {
  return static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace vsslam

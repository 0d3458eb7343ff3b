// MCAP (https://mcap.dev/spec) as ROS 2 records it: profile ros2, CDR messages.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/datasets/formats/chunk_compression.h"
#include "scenarios/datasets/formats/mcap_records.h"
#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/datasets/formats/recording_chunks.h"
#include "scenarios/datasets/messages/message_types.h"

namespace vsslam {

namespace {

// Uncompressed; about two LiDAR scans.
constexpr size_t kChunkBytes = 1 << 20;

// rosbag2 takes a topic's quality of service from the channel: keep the last, reliable, transient local; no deadlines.
constexpr const char* kLatchedQos = R"(- history: 1
  depth: 1
  reliability: 1
  durability: 1
  deadline: {sec: 9223372036, nsec: 854775807}
  lifespan: {sec: 9223372036, nsec: 854775807}
  liveliness: 1
  liveliness_lease_duration: {sec: 9223372036, nsec: 854775807}
  avoid_ros_namespace_conventions: false
)";

/// Records gathered until they fill a chunk.
struct OpenChunk {
  std::string records;
  uint64_t begin_ns = std::numeric_limits<uint64_t>::max(), end_ns = 0;
  std::map<uint16_t, std::vector<std::pair<uint64_t, uint64_t>>> index;  // channel -> (ns, offset in records)
};

class McapWriter : public MessageWriter {
 public:
  explicit McapWriter(const std::filesystem::path& path) : name_(path.string()), file_(path) {
    std::string header;
    put_text("ros2", header);
    put_text("vsslam", header);
    std::string start(kMcapMagic);
    put_record(McapOp::header, header, start);
    append(start);
  }

  void write(const Message& message, bool latched) override;
  void finish() override;

 private:
  McapChannel& channel_of(const Message& message, bool latched);
  uint16_t schema_of(const MessageContent& content);
  void close_chunk();
  void append_message_indexes(McapChunkIndex& index);
  std::string summary() const;
  void append(std::string_view bytes) {
    file_.write(bytes);
    written_ += bytes.size();
  }

  std::string name_;
  AtomicFile file_;
  uint64_t written_ = 0;  // bytes
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<McapChunkIndex> chunks_;
  McapStatistics statistics_{.begin_ns = std::numeric_limits<uint64_t>::max()};
  OpenChunk chunk_;
  std::string message_bytes_, encoded_;
};

void McapWriter::write(const Message& message, bool latched) {
  if (message.recorded.ns <= 0)
    throw InputError(
        fmt::format("{}: a message recorded at {:.3f} s, not after 0", name_, message.recorded.seconds()));
  encode_message(message.content, WireFormat::cdr, encoded_);
  const McapChannel& channel = channel_of(message, latched);
  const auto recorded_ns = static_cast<uint64_t>(message.recorded.ns);
  message_bytes_.clear();
  put_number(message_bytes_, channel.id);
  put_number(message_bytes_, static_cast<uint32_t>(statistics_.channel_messages[channel.id]++));
  put_number(message_bytes_, recorded_ns);
  put_number(message_bytes_, recorded_ns);  // published: the same
  message_bytes_ += encoded_;
  chunk_.index[channel.id].emplace_back(recorded_ns, chunk_.records.size());
  put_record(McapOp::message, message_bytes_, chunk_.records);
  chunk_.begin_ns = std::min(chunk_.begin_ns, recorded_ns);
  chunk_.end_ns = std::max(chunk_.end_ns, recorded_ns);
  ++statistics_.messages;
  if (chunk_.records.size() >= kChunkBytes) close_chunk();
}

McapChannel& McapWriter::channel_of(const Message& message, bool latched) {
  const auto known = std::find_if(channels_.begin(), channels_.end(),
                                  [&](const McapChannel& channel) { return channel.topic == message.topic; });
  if (known != channels_.end()) return *known;
  McapChannel channel{static_cast<uint16_t>(channels_.size() + 1), schema_of(message.content), message.topic,
                      "cdr"};
  if (latched) channel.metadata["offered_qos_profiles"] = kLatchedQos;
  put_record(McapOp::channel, mcap_content(channel), chunk_.records);
  return channels_.emplace_back(std::move(channel));
}

uint16_t McapWriter::schema_of(const MessageContent& content) {
  const std::string type = ros2_type(message_type(content));
  for (const McapSchema& schema : schemas_)
    if (schema.name == type) return schema.id;
  McapSchema schema{static_cast<uint16_t>(schemas_.size() + 1), type, "ros2msg", ros2_definition(content)};
  put_record(McapOp::schema, mcap_content(schema), chunk_.records);
  return schemas_.emplace_back(std::move(schema)).id;
}

void McapWriter::close_chunk() {
  if (chunk_.index.empty()) return;
  const std::string compressed = compress_zstd(chunk_.records);
  std::string content, record;
  put_number(content, chunk_.begin_ns);
  put_number(content, chunk_.end_ns);
  put_number(content, uint64_t{chunk_.records.size()});
  put_number(content, crc32_of(chunk_.records));
  put_text("zstd", content);
  put_number(content, uint64_t{compressed.size()});
  content += compressed;
  put_record(McapOp::chunk, content, record);
  McapChunkIndex index{chunk_.begin_ns,   chunk_.end_ns,        written_, record.size(), {}, 0, "zstd",
                       compressed.size(), chunk_.records.size()};
  append(record);

  append_message_indexes(index);
  chunks_.push_back(std::move(index));
  statistics_.begin_ns = std::min(statistics_.begin_ns, chunk_.begin_ns);
  statistics_.end_ns = std::max(statistics_.end_ns, chunk_.end_ns);
  chunk_ = {};
}

void McapWriter::append_message_indexes(McapChunkIndex& index) {
  const uint64_t indexes_at = written_;
  for (const auto& [channel, places] : chunk_.index) {
    index.message_indexes[channel] = written_;
    std::string entry, entry_record;
    put_number(entry, channel);
    put_number(entry, static_cast<uint32_t>(places.size() * 2 * sizeof(uint64_t)));
    for (const auto& [ns, offset] : places) {
      put_number(entry, ns);
      put_number(entry, offset);
    }
    put_record(McapOp::message_index, entry, entry_record);
    append(entry_record);
  }
  index.message_indexes_size = written_ - indexes_at;
}

std::string McapWriter::summary() const {
  std::string bytes, offsets;
  const auto group = [&](McapOp op, const auto& records) {
    const uint64_t start = bytes.size();
    for (const auto& record : records) put_record(op, mcap_content(record), bytes);
    if (bytes.size() == start) return;
    std::string offset;
    put_number(offset, static_cast<uint8_t>(op));
    put_number(offset, written_ + start);
    put_number(offset, bytes.size() - start);
    put_record(McapOp::summary_offset, offset, offsets);
  };
  group(McapOp::schema, schemas_);
  group(McapOp::channel, channels_);
  group(McapOp::statistics, std::array{statistics_});
  group(McapOp::chunk_index, chunks_);
  const uint64_t offsets_at = written_ + bytes.size();
  bytes += offsets;
  // The footer, up to its own checksum, is part of what that covers.
  put_number(bytes, static_cast<uint8_t>(McapOp::footer));
  put_number(bytes, uint64_t{kMcapFooter});
  put_number(bytes, written_);
  put_number(bytes, offsets_at);
  put_number(bytes, crc32_of(bytes));
  return bytes;
}

void McapWriter::finish() {
  close_chunk();
  std::string end;
  std::string no_checksum;
  put_number(no_checksum, uint32_t{0});  // every chunk has its own
  put_record(McapOp::data_end, no_checksum, end);
  append(end);
  statistics_.schemas = static_cast<uint16_t>(schemas_.size());
  statistics_.channels = static_cast<uint32_t>(channels_.size());
  statistics_.chunks = static_cast<uint32_t>(chunks_.size());
  if (statistics_.messages == 0) statistics_.begin_ns = 0;
  append(summary());
  append(kMcapMagic);
  file_.commit();
}

}  // namespace

std::unique_ptr<MessageWriter> write_mcap(const std::filesystem::path& path) {
  return std::make_unique<McapWriter>(path);
}

}  // namespace vsslam

// MCAP files (https://mcap.dev/spec) in whatever way they may be written: with or without chunks and summary.
#include <fmt/format.h>

#include "core/errors.h"
#include "scenarios/datasets/formats/chunk_compression.h"
#include "scenarios/datasets/formats/mcap_records.h"
#include "scenarios/datasets/formats/recording_chunks.h"
#include "scenarios/datasets/messages/message_types.h"

namespace vsslam {

namespace {

// Messages outside of chunks are read in runs of about so much.
constexpr uint64_t kRunBytes = 1 << 20;

RecordedChunk chunk_of(const McapChunkIndex& index) {
  RecordedChunk chunk{index.offset, index.size, Time{static_cast<int64_t>(index.begin_ns)},
                      Time{static_cast<int64_t>(index.end_ns)}};
  if (index.message_indexes.empty()) return chunk;
  chunk.connections.emplace();
  for (const auto& [channel, place] : index.message_indexes) chunk.connections->push_back(channel);
  return chunk;
}

class McapRecording : public ChunkedRecording {
 public:
  using ChunkedRecording::ChunkedRecording;

  RecordingIndex index() override;
  RecordingIndex scan() override;
  ChunkContent load(const RecordedChunk& chunk) override;

 private:
  struct Footer {
    uint64_t at = 0, summary_at = 0;  // bytes; summary at 0: there is none
    uint32_t crc = 0;                 // of the summary; 0: not known
  };
  Footer read_footer();
  std::string read_summary(const Footer& footer);
  std::optional<RecordingIndex> from_summary();
  std::pair<McapOp, uint64_t> record_at(uint64_t at);
  void add_chunk(const RecordedChunk& chunk, RecordingIndex& index);
  void note(const McapRecord& record);
  void read_chunk(ChunkContent& content);
  void read_records(ChunkContent& content);
  void finish_run(RecordedChunk& run, uint64_t end, RecordingIndex& index);

  std::map<uint16_t, McapSchema> schemas_;
  std::map<uint32_t, RecordedConnection> channels_;
};

/// Remembers schemas and channels.
void McapRecording::note(const McapRecord& record) {
  if (record.op == McapOp::schema) {
    McapSchema schema = mcap_schema(record.content);
    schemas_.try_emplace(schema.id, std::move(schema));
  } else if (record.op == McapOp::channel) {
    McapChannel channel = mcap_channel(record.content);
    const auto schema = schemas_.find(channel.schema);
    std::optional<WireFormat> format;
    if (channel.encoding == "cdr") format = WireFormat::cdr;
    if (channel.encoding == "ros1") format = WireFormat::ros1;
    channels_.try_emplace(
        channel.id,
        RecordedConnection{std::move(channel.topic),
                           schema == schemas_.end() ? "" : ros1_type(schema->second.name), format});
  }
}

RecordingIndex McapRecording::index() {
  if (file_.read_available(file_.size() - kMcapMagic.size(), kMcapMagic.size()) != kMcapMagic)
    throw InputError(fmt::format(
        "ends at byte {} without MCAP's closing mark: its recording was not finished", file_.size()));
  if (std::optional<RecordingIndex> index = from_summary()) return *std::move(index);
  RecordingIndex index = scan();
  if (!index.damage.empty()) throw InputError(index.damage);
  return index;
}

McapRecording::Footer McapRecording::read_footer() {
  const uint64_t tail = kMcapRecordHeader + kMcapFooter + kMcapMagic.size();
  const uint64_t at = file_.size() - std::min(tail, file_.size());
  const std::string bytes = file_.read(at, kMcapRecordHeader + kMcapFooter);
  std::string start;
  put_number(start, static_cast<uint8_t>(McapOp::footer));
  put_number(start, uint64_t{kMcapFooter});
  if (!bytes.starts_with(start)) throw InputError(fmt::format("byte {}: no footer is here", at));
  ByteCursor fields(std::string_view(bytes).substr(kMcapRecordHeader));
  Footer footer{at, fields.number<uint64_t>(), 0};
  fields.take(sizeof(uint64_t));  // where the summary's offsets are
  footer.crc = fields.number<uint32_t>();
  if (footer.summary_at > at)
    throw InputError(fmt::format("byte {}: a summary at {} cannot be", at, footer.summary_at));
  return footer;
}

/// The summary's records, without the footer.
std::string McapRecording::read_summary(const Footer& footer) {
  std::string summary = file_.read(footer.summary_at, file_.size() - footer.summary_at);
  const size_t covered = summary.size() - kMcapMagic.size() - sizeof footer.crc;
  if (footer.crc != 0 && footer.crc != crc32_of(std::string_view(summary).substr(0, covered)))
    throw InputError(fmt::format("the summary at byte {} does not have its checksum", footer.summary_at));
  summary.resize(footer.at - footer.summary_at);
  return summary;
}

/// nullopt: the file has no index of its chunks.
std::optional<RecordingIndex> McapRecording::from_summary() {
  const Footer footer = read_footer();
  if (footer.summary_at == 0) return std::nullopt;
  const std::string summary = read_summary(footer);
  RecordingIndex index;
  std::optional<McapStatistics> statistics;
  try {
    for (ByteCursor cursor(summary); cursor.left() > 0;) {
      const McapRecord record(cursor);
      note(record);
      if (record.op == McapOp::statistics) statistics = mcap_statistics(record.content);
      if (record.op == McapOp::chunk_index)
        index.chunks.push_back(chunk_of(mcap_chunk_index(record.content)));
    }
  } catch (const InputError& error) {
    throw InputError(fmt::format("summary at byte {} is broken: {}", footer.summary_at, error.what()));
  }
  if (!statistics || channels_.size() != statistics->channels || index.chunks.size() != statistics->chunks ||
      (index.chunks.empty() && statistics->messages > 0))
    return std::nullopt;
  index.connections = channels_;
  for (const auto& [channel, messages] : statistics->channel_messages) index.messages[channel] = messages;
  return index;
}

RecordingIndex McapRecording::scan() {
  RecordingIndex index;
  uint64_t at = kMcapMagic.size();
  RecordedChunk run;  // records outside of chunks
  run.offset = at;
  try {
    for (bool ended = false; !ended && index.damage.empty();) {
      const auto [op, size] = record_at(at);
      if (op == McapOp::chunk) {
        finish_run(run, at, index);
        run.size = std::min(size, file_.size() - at);
        add_chunk(run, index);
        run = {.offset = at + run.size};
      }
      if (size > file_.size() - at)
        throw InputError(fmt::format("a record of {} bytes, where the file has {}", size, file_.size() - at));
      at += size;
      ended = op == McapOp::data_end;
      if (ended || at - run.offset >= kRunBytes) finish_run(run, at, index);
    }
  } catch (const InputError& error) {
    finish_run(run, at, index);
    if (index.damage.empty()) index.damage = fmt::format("byte {}: {}", at, error.what());
  }
  index.connections = channels_;
  return index;
}

/// Opcode and size of the record at byte `at`, with its header.
std::pair<McapOp, uint64_t> McapRecording::record_at(uint64_t at) {
  const std::string header = file_.read(at, kMcapRecordHeader);
  ByteCursor cursor(header);
  const auto op = static_cast<McapOp>(cursor.number<uint8_t>());
  // Broken sizes may be anything: the sum must not wrap around.
  const auto size = std::min(cursor.number<uint64_t>(), uint64_t{1} << 62);
  return {op, kMcapRecordHeader + size};
}

void McapRecording::add_chunk(const RecordedChunk& chunk, RecordingIndex& index) {
  const ChunkContent content = load(chunk);
  count(chunk, content, index);
  if (index.damage.empty()) index.damage = content.damage;
}

/// Closes the run of records outside of chunks before byte `end`, and begins another there.
void McapRecording::finish_run(RecordedChunk& run, uint64_t end, RecordingIndex& index) {
  run.size = end - std::min(end, run.offset);
  if (run.size > 0) add_chunk(run, index);
  run = {.offset = end};
}

ChunkContent McapRecording::load(const RecordedChunk& chunk) {
  ChunkContent content;
  try {
    content.bytes = file_.read_available(chunk.offset, chunk.size);
    if (!content.bytes.empty() && static_cast<McapOp>(content.bytes.front()) == McapOp::chunk)
      read_chunk(content);
    else
      read_records(content);
  } catch (const InputError& error) {
    content.damage = fmt::format("chunk at byte {}: {}", chunk.offset, error.what());
  }
  return content;
}

/// `content` holds the chunk's record, and then what is in it.
void McapRecording::read_chunk(ChunkContent& content) {
  const std::string stored = std::move(content.bytes);
  content.bytes.clear();
  ByteCursor cursor(stored);
  cursor.take(kMcapRecordHeader + 2 * sizeof(uint64_t));
  const auto announced = cursor.number<uint64_t>();
  const auto crc = cursor.number<uint32_t>();
  const std::string_view compression = cursor.counted<uint32_t>();
  const auto compressed_size = cursor.number<uint64_t>();
  if (announced > kMaxChunkBytes) throw InputError(fmt::format("announces {} bytes", announced));
  Decompressed records =
      decompress(compression, cursor.take(std::min<uint64_t>(compressed_size, cursor.left())), announced);
  if (records.damage.empty() && crc != 0 && crc != crc32_of(records.bytes))
    throw InputError("its content does not have its checksum");
  content.bytes = std::move(records.bytes);
  read_records(content);
  if (!records.damage.empty()) throw InputError(records.damage);
}

void McapRecording::read_records(ChunkContent& content) {
  for (ByteCursor cursor(content.bytes); cursor.left() > 0;) {
    const McapRecord record(cursor);
    note(record);
    if (record.op != McapOp::message) continue;
    ByteCursor fields(record.content);
    const auto channel = fields.number<uint16_t>();
    fields.take(sizeof(uint32_t));  // sequence
    const auto recorded_ns = fields.number<uint64_t>();
    fields.take(sizeof(uint64_t));  // published
    const std::string_view message = fields.take(fields.left());
    content.messages.push_back({Time{static_cast<int64_t>(recorded_ns)}, channel,
                                static_cast<size_t>(message.data() - content.bytes.data()), message.size()});
  }
}

}  // namespace

std::unique_ptr<ChunkedRecording> open_mcap(const std::filesystem::path& path) {
  return std::make_unique<McapRecording>(path);
}

}  // namespace vsslam

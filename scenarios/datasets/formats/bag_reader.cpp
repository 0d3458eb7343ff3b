// Bags of ROS 1, format 2.0 (http://wiki.ros.org/Bags/Format/2.0): records of a header and data, each after its length.
#include <fmt/format.h>

#include "core/errors.h"
#include "scenarios/datasets/formats/chunk_compression.h"
#include "scenarios/datasets/formats/recording_chunks.h"
#include "scenarios/datasets/messages/byte_cursor.h"
#include "scenarios/datasets/messages/message_types.h"

namespace vsslam {

namespace {

enum class Op : uint8_t {
  message = 2,
  file_header = 3,
  index_data = 4,
  chunk = 5,
  chunk_info = 6,
  connection = 7
};

/// name=value, each pair after its length.
class BagFields {
 public:
  explicit BagFields(std::string_view header) {
    for (ByteCursor cursor(header); cursor.left() > 0;) {
      const std::string_view field = cursor.counted<uint32_t>();
      const size_t equals = field.find('=');
      if (equals == std::string_view::npos) throw InputError("a record's header has a field without a value");
      values_[std::string(field.substr(0, equals))] = field.substr(equals + 1);
    }
  }
  std::string_view text(std::string_view name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) throw InputError(fmt::format("a record's header has no field \"{}\"", name));
    return found->second;
  }
  template <Number T>
  T number(std::string_view name) const {
    return ByteCursor(text(name)).number<T>();
  }
  Op op() const { return static_cast<Op>(number<uint8_t>("op")); }
  Time time(std::string_view name) const {
    ByteCursor cursor(text(name));
    const auto s = cursor.number<uint32_t>(), ns = cursor.number<uint32_t>();
    return {int64_t{s} * 1'000'000'000 + ns};
  }

 private:
  std::map<std::string, std::string, std::less<>> values_;
};

struct BagRecord {
  BagFields fields;
  std::string_view data;

  explicit BagRecord(ByteCursor& cursor)
      : fields(cursor.counted<uint32_t>()), data(cursor.counted<uint32_t>()) {}
};

void add_connection(const BagRecord& record, std::map<uint32_t, RecordedConnection>& connections) {
  connections.try_emplace(
      record.fields.number<uint32_t>("conn"),
      RecordedConnection{std::string(record.fields.text("topic")),
                         ros1_type(BagFields(record.data).text("type")), WireFormat::ros1});
}

/// A record in the file whose data may be cut short.
struct RecordPlace {
  BagFields fields;
  uint64_t data_offset = 0;
  uint32_t data_size = 0;
  uint64_t end() const { return data_offset + data_size; }
};

class BagRecording : public ChunkedRecording {
 public:
  using ChunkedRecording::ChunkedRecording;

  RecordingIndex index() override;
  RecordingIndex scan() override;
  ChunkContent load(const RecordedChunk& chunk) override;

 private:
  RecordPlace record_at(uint64_t offset);
  void read_records(ChunkContent& content);

  // As met in chunks.
  std::map<uint32_t, RecordedConnection> connections_;
};

RecordPlace BagRecording::record_at(uint64_t offset) {
  const auto header_size = ByteCursor(file_.read(offset, 4)).number<uint32_t>();
  BagFields fields(file_.read(offset + 4, header_size));
  const uint64_t data = offset + 4 + header_size;
  const auto data_size = ByteCursor(file_.read(data, 4)).number<uint32_t>();
  return {std::move(fields), data + 4, data_size};
}

RecordingIndex BagRecording::index() {
  const RecordPlace file_header = record_at(kBagMagic.size());
  const auto index_at = file_header.fields.number<uint64_t>("index_pos");
  if (index_at == 0) throw InputError("has no index: its recording was not finished");
  if (index_at > file_.size())
    throw InputError(fmt::format("ends at byte {}, before its index at {} (--salvage reads what is before the break)", file_.size(), index_at));
  RecordingIndex index;
  const std::string bytes = file_.read(index_at, file_.size() - index_at);
  ByteCursor cursor(bytes);
  try {
    for (auto n = file_header.fields.number<uint32_t>("conn_count"); n > 0; --n)
      add_connection(BagRecord(cursor), index.connections);
    for (auto n = file_header.fields.number<uint32_t>("chunk_count"); n > 0; --n) {
      const BagRecord info(cursor);
      RecordedChunk chunk{info.fields.number<uint64_t>("chunk_pos"), 0, info.fields.time("start_time"),
                          info.fields.time("end_time"), std::vector<uint32_t>{}};
      for (ByteCursor counts(info.data); counts.left() > 0;) {
        const auto connection = counts.number<uint32_t>(), messages = counts.number<uint32_t>();
        chunk.connections->push_back(connection);
        index.messages[connection] += messages;
      }
      index.chunks.push_back(std::move(chunk));
    }
  } catch (const InputError& error) {
    throw InputError(fmt::format("index at byte {} is broken: {}", index_at, error.what()));
  }
  return index;
}

RecordingIndex BagRecording::scan() {
  RecordingIndex index;
  uint64_t at = kBagMagic.size();
  try {
    while (at < file_.size() && index.damage.empty()) {
      const RecordPlace record = record_at(at);
      if (record.fields.op() == Op::chunk) {
        const RecordedChunk chunk{at, record.end() - at, {}, {}};
        const ChunkContent content = load(chunk);
        count(chunk, content, index);
        index.damage = content.damage;
      }
      at = record.end();
    }
  } catch (const InputError& error) {
    index.damage = fmt::format("byte {}: {}", at, error.what());
  }
  index.connections = connections_;
  return index;
}

ChunkContent BagRecording::load(const RecordedChunk& chunk) {
  ChunkContent content;
  try {
    const RecordPlace record = record_at(chunk.offset);
    if (record.fields.op() != Op::chunk) throw InputError("no chunk is here");
    auto announced = uint64_t{record.fields.number<uint32_t>("size")};
    uint64_t stored = record.data_size;
    // The lengths are filled in when a chunk is full: this one never was.
    const bool unfinished = announced == 0 && stored == 0;
    if (unfinished) announced = kMaxChunkBytes, stored = file_.size();
    Decompressed records = decompress(record.fields.text("compression"),
                                      file_.read_available(record.data_offset, stored), announced);
    content.bytes = std::move(records.bytes);
    read_records(content);
    if (!records.damage.empty())
      throw InputError(unfinished ? "its recording was not finished" : std::move(records.damage));
  } catch (const InputError& error) {
    content.damage = fmt::format("chunk at byte {}: {}", chunk.offset, error.what());
  }
  return content;
}

void BagRecording::read_records(ChunkContent& content) {
  for (ByteCursor cursor(content.bytes); cursor.left() > 0;) {
    const BagRecord record(cursor);
    if (record.fields.op() == Op::connection)
      add_connection(record, connections_);
    else if (record.fields.op() == Op::message)
      content.messages.push_back({record.fields.time("time"), record.fields.number<uint32_t>("conn"),
                                  static_cast<size_t>(record.data.data() - content.bytes.data()),
                                  record.data.size()});
  }
}

}  // namespace

std::unique_ptr<ChunkedRecording> open_bag(const std::filesystem::path& path) {
  return std::make_unique<BagRecording>(path);
}

}  // namespace vsslam

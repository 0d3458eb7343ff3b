#include "scenarios/datasets/formats/message_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <queue>
#include <set>

#include "core/errors.h"
#include "scenarios/datasets/formats/recording_chunks.h"
#include "scenarios/datasets/messages/message_types.h"

namespace vsslam {

namespace {

/// A message whose turn comes: by time, then by place in the file.
struct Pending {
  Time recorded;
  size_t chunk = 0, message = 0;  // in the index, in the chunk
  auto operator<=>(const Pending&) const = default;
};

class ChunkedReader : public MessageReader {
 public:
  ChunkedReader(std::unique_ptr<ChunkedRecording> recording, const ReadOptions& options);

  const std::vector<RecordedTopic>& topics() const override { return topics_; }
  Time begin() const override { return begin_; }
  Time end() const override { return end_; }
  std::optional<Message> next() override;
  const std::string& damage() const override { return damage_; }

 private:
  void open();
  void list_topics();
  void choose_connections();
  void queue_chunks();
  void begin_due_chunks();
  void begin_chunk(size_t chunk);
  const ChunkContent& content_of(size_t chunk);
  Message decode(const Pending& pending);
  void break_off(const std::string& damage);

  struct Loaded {
    size_t chunk;
    ChunkContent content;
  };

  std::unique_ptr<ChunkedRecording> recording_;
  ReadOptions options_;
  RecordingIndex index_;
  std::vector<RecordedTopic> topics_;
  Time begin_, end_;
  std::set<uint32_t> wanted_;    // connections
  std::vector<size_t> waiting_;  // chunks not begun, the first in time last
  std::priority_queue<Pending, std::vector<Pending>, std::greater<>> pending_;
  std::list<Loaded> loaded_;  // the last used first
  std::string damage_;
};

ChunkedReader::ChunkedReader(std::unique_ptr<ChunkedRecording> recording, const ReadOptions& options)
    : recording_(std::move(recording)), options_(options) {
  open();
  list_topics();
  choose_connections();
  queue_chunks();
}

void ChunkedReader::open() {
  try {
    index_ = recording_->index();
  } catch (const InputError& error) {
    break_off(error.what());
    index_ = recording_->scan();
    if (!index_.damage.empty()) break_off(index_.damage);
  }
}

void ChunkedReader::list_topics() {
  std::map<std::pair<std::string, std::string>, uint64_t> messages;
  for (const auto& [id, connection] : index_.connections)
    messages[{connection.topic, connection.type}] += index_.messages[id];
  for (const auto& [topic, count] : messages) topics_.push_back({topic.first, topic.second, count});
}

void ChunkedReader::choose_connections() {
  for (const auto& [id, connection] : index_.connections) {
    const bool asked_for =
        options_.topics.empty() ||
        std::find(options_.topics.begin(), options_.topics.end(), connection.topic) != options_.topics.end();
    if (asked_for && connection.format && empty_message(connection.type)) wanted_.insert(id);
  }
}

void ChunkedReader::queue_chunks() {
  for (size_t i = 0; i < index_.chunks.size(); ++i) {
    const RecordedChunk& chunk = index_.chunks[i];
    begin_ = i == 0 ? chunk.begin : std::min(begin_, chunk.begin);
    end_ = i == 0 ? chunk.end : std::max(end_, chunk.end);
    if (!chunk.connections || std::any_of(chunk.connections->begin(), chunk.connections->end(),
                                          [&](uint32_t id) { return wanted_.contains(id); }))
      waiting_.push_back(i);
  }
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [&](size_t a, size_t b) { return index_.chunks[a].begin > index_.chunks[b].begin; });
}

std::optional<Message> ChunkedReader::next() {
  begin_due_chunks();
  if (pending_.empty()) return std::nullopt;
  const Pending pending = pending_.top();
  pending_.pop();
  try {
    return decode(pending);
  } catch (const InputError& error) {
    break_off(error.what());
    pending_ = {};
    waiting_.clear();
    return std::nullopt;
  }
}

/// No message may come before one of a chunk that begins earlier.
void ChunkedReader::begin_due_chunks() {
  while (!waiting_.empty() &&
         (pending_.empty() || index_.chunks[waiting_.back()].begin <= pending_.top().recorded)) {
    const size_t chunk = waiting_.back();
    waiting_.pop_back();
    begin_chunk(chunk);
  }
}

void ChunkedReader::begin_chunk(size_t chunk) {
  const ChunkContent& content = content_of(chunk);
  for (size_t i = 0; i < content.messages.size(); ++i)
    if (wanted_.contains(content.messages[i].connection))
      pending_.push({content.messages[i].recorded, chunk, i});
  if (content.damage.empty()) return;
  break_off(content.damage);
  std::erase_if(waiting_, [&](size_t other) { return other > chunk; });
}

const ChunkContent& ChunkedReader::content_of(size_t chunk) {
  const auto found = std::find_if(loaded_.begin(), loaded_.end(),
                                  [&](const Loaded& loaded) { return loaded.chunk == chunk; });
  if (found != loaded_.end()) {
    loaded_.splice(loaded_.begin(), loaded_, found);
    return loaded_.front().content;
  }
  loaded_.push_front({chunk, recording_->load(index_.chunks[chunk])});
  size_t bytes = 0;
  for (auto loaded = loaded_.begin(); loaded != loaded_.end();) {
    bytes += loaded->content.bytes.size();
    const bool let_go = bytes > options_.chunk_memory_bytes && loaded != loaded_.begin();
    loaded = let_go ? loaded_.erase(loaded) : std::next(loaded);
  }
  return loaded_.front().content;
}

Message ChunkedReader::decode(const Pending& pending) {
  const ChunkContent& content = content_of(pending.chunk);
  const ChunkContent::Message& place = content.messages.at(pending.message);
  const RecordedConnection& connection = index_.connections.at(place.connection);
  try {
    const std::string_view bytes = std::string_view(content.bytes).substr(place.offset, place.size);
    return {connection.topic, pending.recorded,
            options_.headers_only ? decode_header(connection.type, bytes, *connection.format)
                                  : decode_message(connection.type, bytes, *connection.format)};
  } catch (const InputError& error) {
    throw InputError(fmt::format("message on {} at {:.3f} s: {}", connection.topic,
                                 pending.recorded.seconds(), error.what()));
  }
}

/// Notes where a salvage ends; without one, that is the end of everything.
void ChunkedReader::break_off(const std::string& damage) {
  damage_ = fmt::format("{}: {}", recording_->name(), damage);
  if (!options_.salvage) throw InputError(damage_);
}

}  // namespace

std::unique_ptr<MessageReader> read_messages(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string start = ByteFile(path).read_available(0, kBagMagic.size());
  std::unique_ptr<ChunkedRecording> recording;
  if (start.starts_with(kMcapMagic))
    recording = open_mcap(path);
  else if (start == kBagMagic)
    recording = open_bag(path);
  else if (start.starts_with("#ROSBAG"))
    throw InputError(fmt::format(
        "{}: a bag of another format than 2.0 (rosbag fix, or rosbag migrate, converts it)", path.string()));
  else
    throw InputError(fmt::format("{}: neither a ROS 1 bag, nor an MCAP file, nor Velodyne packets (pcap, pcapng, or 1206 bytes each)", path.string()));
  return std::make_unique<ChunkedReader>(std::move(recording), options);
}

}  // namespace vsslam

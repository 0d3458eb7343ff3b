#include "scenarios/datasets/import/message_survey.h"

#include <algorithm>

#include "core/errors.h"

namespace vsslam {

namespace {

constexpr size_t kClouds = 24, kImages = 10, kTimedClouds = 11;
constexpr Duration kLookAhead{5'000'000'000};
constexpr int kMostRings = 256;

struct FirstMessages {
  std::vector<PointCloudMessage> clouds;
  PixelDepth depth;
};

FirstMessages first_messages(MessageReader& reader) {
  FirstMessages first;
  size_t images = 0;
  std::optional<Time> begin;
  while (std::optional<Message> message = reader.next()) {
    if (!begin) begin = message->recorded;
    if (message->recorded - *begin > kLookAhead) break;
    if (auto* cloud = std::get_if<PointCloudMessage>(&message->content);
        cloud != nullptr && first.clouds.size() < kClouds)
      first.clouds.push_back(std::move(*cloud));
    if (const auto* image = std::get_if<ImageMessage>(&message->content);
        image != nullptr && images < kImages)
      first.depth.after(*image), ++images;
    if (first.clouds.size() == kClouds && images == kImages) break;
  }
  return first;
}

/// Positions and rings, as far as they make sense.
CloudDecoder::Options still() {
  return {.rings = kMostRings, .undistorted = true, .parts = {}};
}

// The highest of which there are more than some odd points.
int rings_of(const std::vector<LidarScan>& scans, bool known) {
  std::vector<size_t> points(kMostRings);
  size_t all = 0;
  for (const LidarScan& scan : scans) {
    if (scan.rings_known != known) continue;
    for (const LidarPoint& p : scan.points) ++points[p.ring];
    all += scan.points.size();
  }
  int rings = kMostRings;
  while (rings > 0 && points[static_cast<size_t>(rings - 1)] <= all / 2000) --rings;
  return rings;
}

std::vector<LidarScan> decoded(const std::vector<PointCloudMessage>& clouds,
                               const CloudDecoder::Options& options) {
  CloudDecoder decoder(options);
  std::vector<LidarScan> scans;
  for (const PointCloudMessage& cloud : clouds) scans.push_back(decoder.decode(cloud, "lidar"));
  return scans;
}

Duration usual_length(std::vector<PointCloudMessage> clouds, const CloudDecoder::Options& options) {
  if (clouds.empty()) return {};
  clouds.resize(std::min(clouds.size(), kTimedClouds));
  const std::vector<LidarScan> scans = decoded(clouds, options);
  std::vector<Duration> lengths;
  for (size_t i = 0; i < scans.size(); ++i) lengths.push_back(scans[i].end - clouds[i].header.stamp);
  std::sort(lengths.begin(), lengths.end());
  return lengths[lengths.size() / 2];
}

Receipt receipt_of(const Message& message) {
  Receipt receipt{message.recorded, message.recorded};
  std::visit(
      [&](const auto& content) {
        if constexpr (requires { content.header; })
          if (content.header.stamp.ns != 0) receipt.end = content.header.stamp;
      },
      message.content);
  return receipt;
}

}  // namespace

FirstLook look_at_first(MessageReader& reader, const CloudDecoder::Options& clouds) {
  FirstLook look;
  try {
    const FirstMessages first = first_messages(reader);
    look.depth = first.depth;
    look.rings = rings_of_clouds(first.clouds, clouds);
    look.parts = parts_of_turns(decoded(first.clouds, still()));
    CloudDecoder::Options options = clouds;
    options.rings = std::max(options.rings, look.rings);
    options.parts = look.parts;
    look.scan_lasts = usual_length(first.clouds, options);
  } catch (const InputError&) {
    // Whoever reads the recording will come to it, and say where it is.
  }
  return look;
}

int rings_of_clouds(const std::vector<PointCloudMessage>& clouds, const CloudDecoder::Options& options) {
  if (const int told = rings_of(decoded(clouds, still()), true); told > 0) return told;
  CloudDecoder::Options guessing = options;
  guessing.undistorted = true;
  guessing.rings = std::min(guessing.rings, kMostRings);
  return rings_of(decoded(clouds, guessing), false);
}

std::vector<ReceivedStream> received_streams(MessageReader& headers, const TopicChoice& topics,
                                             Duration scan_lasts) {
  std::vector<ReceivedStream> streams;
  for (const char* sensor : {"imu", "wheels", "lidar", "camera", "truth"})
    if (const auto topic = topics.find(sensor); topic != topics.end())
      streams.push_back({sensor, topic->second, {}});
  try {
    size_t place = 0;
    for (; const std::optional<Message> message = headers.next(); ++place)
      for (ReceivedStream& stream : streams) {
        if (stream.name != message->topic) continue;
        Receipt receipt = receipt_of(*message);
        receipt.place = place;
        if (stream.sensor == "lidar") receipt.end = receipt.end + scan_lasts;
        stream.messages.push_back(receipt);
      }
  } catch (const InputError&) {
    // As above.
  }
  return streams;
}

}  // namespace vsslam

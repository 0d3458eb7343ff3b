#include "scenarios/datasets/import/packet_recording.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "core/errors.h"

namespace vsslam {

namespace {

constexpr int64_t kHour_ns = 3'600'000'000'000, kHalfHour_us = 1'800'000'000;
constexpr Duration kLongestBetweenPackets{5'000'000};

// Of dual returns each direction comes twice; that is no step back.
size_t turns_begun(const std::vector<VelodynePacket>& packets) {
  size_t turns = 0;
  std::optional<uint16_t> last;
  for (size_t p = 0; p < packets.size(); ++p)
    for (size_t b = 0; b < packets[p].blocks.size(); ++b) {
      const bool at_the_end = p + 1 == packets.size() && b + 2 >= packets[p].blocks.size();
      if (at_the_end) continue;  // the decoder needs what follows
      const uint16_t azimuth = packets[p].blocks[b].azimuth_cdeg;
      turns += last && azimuth < *last;
      last = azimuth;
    }
  return turns;
}

}  // namespace

PacketRecording::PacketRecording(PacketReader reader, std::string file, int rings, double expected_s)
    : reader_(std::move(reader)), file_(std::move(file)), rings_(rings) {
  facts_.format = "Velodyne packets";
  facts_.streams = {{"packets", "Velodyne", 0, "lidar"}};
  facts_.expected_duration_s = expected_s;
  facts_.has[Sample(LidarScan{}).index()] = true;
}

std::optional<RecordedSample> PacketRecording::next() {
  while (scans_.empty())
    if (!take()) return std::nullopt;
  LidarScan scan = std::move(scans_.front());
  scans_.pop_front();
  const Time end = scan.end;
  return RecordedSample{std::move(scan), end};
}

Time PacketRecording::stamp_of(const ReceivedPacket& received) {
  const uint32_t us = received.packet.stamp_us;
  const int64_t past_hour_ns = int64_t{us} * 1000;
  if (!last_stamp_us_ && received.received) {
    // The hour that puts the packet nearest to when it was received.
    hour_ = (received.received->ns - past_hour_ns + kHour_ns / 2) / kHour_ns;
  } else if (last_stamp_us_ && int64_t{us} + kHalfHour_us < *last_stamp_us_) {
    ++hour_;
  }
  last_stamp_us_ = us;
  return Time{hour_ * kHour_ns + past_hour_ns};
}

bool PacketRecording::take() {
  std::optional<ReceivedPacket> received = reader_();
  if (!received) return false;
  ++facts_.streams.front().messages;
  if (!decoder_) {
    const int lasers = static_cast<int>(laser_table(received->packet.model).lasers.size());
    if (lasers != rings_)
      throw InputError(
          fmt::format("{}: packets of a LiDAR of {} rings, but the rig's sheet has {} (lidar.rings)", file_,
                      lasers, rings_));
    decoder_.emplace(received->packet.model);
  }
  const Time first = stamp_of(*received);
  if (!packets_.empty() && first - first_firings_.back() > kLongestBetweenPackets) {
    ++breaks_;
    packets_.clear();
    first_firings_.clear();
  }
  packets_.push_back(received->packet);
  first_firings_.push_back(first);
  decode();
  return true;
}

// Once a revolution is whole it is decoded; the packet in which the next one begins stays.
void PacketRecording::decode() {
  if (turns_begun(packets_) < 2) return;
  for (LidarScan& scan : decoder_->scans(packets_, first_firings_.front())) scans_.push_back(std::move(scan));
  packets_.erase(packets_.begin(), packets_.end() - 2);
  first_firings_.erase(first_firings_.begin(), first_firings_.end() - 2);
}

std::vector<std::string> PacketRecording::notes() const {
  if (breaks_ == 0) return {};
  return {
      fmt::format("lidar: packets are missing at {} places: the revolutions there are left out", breaks_)};
}

}  // namespace vsslam

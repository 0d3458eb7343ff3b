// Velodyne packets: from a network capture (pcap), or one after another in a file.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/datasets/import/recording.h"
#include "sensors/lidar/velodyne_packets.h"

namespace vsslam {

/// A packet and when it was received; nullopt: nothing says when.
struct ReceivedPacket {
  VelodynePacket packet;
  std::optional<Time> received;
};
/// The next packet; nullopt: the end.
using PacketReader = std::function<std::optional<ReceivedPacket>()>;

bool is_packet_file(const std::filesystem::path& path);
bool is_pcap_file(const std::filesystem::path& path);
/// Packets of 1206 bytes without anything between. Throws InputError, also while reading.
PacketReader read_packet_file(const std::filesystem::path& path, bool salvage);
/// UDP datagrams of 1206 bytes to port 2368, over IPv4. Throws InputError, also while reading.
PacketReader read_pcap_file(const std::filesystem::path& path, bool salvage);

/// Whole revolutions as scans. Stamps are the device's own clock, microseconds past the hour; the hour is that of the
/// capture, or the first of all.
class PacketRecording final : public Recording {
 public:
  /// `rings`: of the rig's sheet, which must be the device's. `expected_s`: how long it may last.
  PacketRecording(PacketReader reader, std::string file, int rings, double expected_s);

  const RecordingFacts& facts() const override { return facts_; }
  std::optional<RecordedSample> next() override;
  std::vector<std::string> notes() const override;

 private:
  bool take();  ///< false: no packet left
  Time stamp_of(const ReceivedPacket& received);
  void decode();

  PacketReader reader_;
  std::string file_;
  int rings_;
  RecordingFacts facts_;
  std::vector<VelodynePacket> packets_;  // of the revolution that is not whole yet
  std::vector<Time> first_firings_;      // of each
  std::deque<LidarScan> scans_;
  std::optional<VelodyneDecoder> decoder_;
  std::optional<uint32_t> last_stamp_us_;
  int64_t hour_ = 0;
  int64_t breaks_ = 0;
};

}  // namespace vsslam

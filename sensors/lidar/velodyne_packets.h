// Velodyne's data packets: 1206 bytes as the device sends them over the network.
//
//   12 blocks of 100 bytes: 0xFF 0xEE, azimuth (uint16, 0.01 deg clockwise), 32 channels of range (uint16,
//   0 = no return) and reflectivity (uint8); then a time stamp (uint32, microseconds past the hour), the
//   return mode and the model.  All little-endian. A VLP-16 block holds two firing cycles of 16 lasers, a
//   VLP-32C block one of 32. In dual mode two neighbouring blocks hold the last and the strongest return.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "core/samples.h"
#include "sensors/lidar/laser_table.h"

namespace vsslam {

struct VelodyneChannel {
  uint16_t range = 0;  ///< in range steps of the model, 0: no return
  uint8_t reflectivity = 0;
};

struct VelodyneBlock {
  uint16_t azimuth_cdeg = 0;  ///< hundredths of a degree, clockwise, below 36000
  std::array<VelodyneChannel, 32> channels;
};

struct VelodynePacket {
  static constexpr size_t kBytes = 1206;
  enum class ReturnMode : uint8_t { strongest = 0x37, last = 0x38, dual = 0x39 };
  std::array<VelodyneBlock, 12> blocks;
  uint32_t stamp_us = 0;  ///< past the hour
  ReturnMode mode = ReturnMode::strongest;
  LidarModel model = LidarModel::vlp16;
};

/// Decodes one packet. Throws InputError that starts with `place` if it is not one.
VelodynePacket decode_packet(std::span<const uint8_t> bytes, std::string_view place);

/// Packets one after another without headers. Throws InputError with the file's name and the packet's number.
std::vector<VelodynePacket> read_packets(const std::filesystem::path& path);

/// One firing of one laser.
struct VelodyneFiring {
  int64_t cycle = 0;       ///< firing cycle, counted from the first packet
  int laser = 0;           ///< id
  double azimuth_rad = 0;  ///< counter-clockwise from forward, of the beam at its firing
  double range_m = 0;      ///< 0: no return
  uint8_t reflectivity = 0;
};

/// Puts packets in order: azimuths interpolated between blocks, and cut into revolutions where the azimuth
/// passes forward. Of dual returns the strongest are taken. Packets must follow each other without a gap.
class VelodyneDecoder {
 public:
  explicit VelodyneDecoder(LidarModel model) : table_(laser_table(model)) {}
  /// Firings of all blocks but the last, whose turning speed is not known yet.
  std::vector<VelodyneFiring> firings(std::span<const VelodynePacket> packets) const;
  /// Whole revolutions as scans; `first` is the time of the first firing.
  std::vector<LidarScan> scans(std::span<const VelodynePacket> packets, Time first) const;

 private:
  const LaserTable& table_;
};

}  // namespace vsslam

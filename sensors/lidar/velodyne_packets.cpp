#include "sensors/lidar/velodyne_packets.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/files.h"

namespace vsslam {

namespace {

constexpr size_t kBlockBytes = 100, kChannelBytes = 3, kChannelsAt = 4, kStampAt = 1200;
constexpr uint8_t kFactoryVlp16 = 0x22, kFactoryVlp32c = 0x28;

uint16_t read_u16(std::span<const uint8_t> bytes, size_t at) {
  return static_cast<uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

VelodyneBlock decode_block(std::span<const uint8_t> bytes, std::string_view place, size_t number) {
  if (bytes[0] != 0xFF || bytes[1] != 0xEE)
    throw InputError(fmt::format("{}: block {}: expected the flag ff ee, got {:02x} {:02x}", place, number,
                                 bytes[0], bytes[1]));
  VelodyneBlock block;
  block.azimuth_cdeg = read_u16(bytes, 2);
  if (block.azimuth_cdeg >= 36000)
    throw InputError(
        fmt::format("{}: block {}: expected an azimuth below 36000 hundredths of a degree, got {}", place,
                    number, block.azimuth_cdeg));
  for (size_t c = 0; c < block.channels.size(); ++c) {
    const size_t at = kChannelsAt + kChannelBytes * c;
    block.channels[c] = {read_u16(bytes, at), bytes[at + 2]};
  }
  return block;
}

}  // namespace

VelodynePacket decode_packet(std::span<const uint8_t> bytes, std::string_view place) {
  if (bytes.size() != VelodynePacket::kBytes)
    throw InputError(
        fmt::format("{}: expected {} bytes, got {}", place, VelodynePacket::kBytes, bytes.size()));
  VelodynePacket packet;
  for (size_t b = 0; b < packet.blocks.size(); ++b)
    packet.blocks[b] = decode_block(bytes.subspan(kBlockBytes * b, kBlockBytes), place, b);
  packet.stamp_us = static_cast<uint32_t>(read_u16(bytes, kStampAt)) |
                    static_cast<uint32_t>(read_u16(bytes, kStampAt + 2)) << 16;
  const uint8_t mode = bytes[kStampAt + 4], model = bytes[kStampAt + 5];
  if (mode < 0x37 || mode > 0x39)
    throw InputError(fmt::format("{}: expected a return mode of 37, 38 or 39, got {:02x}", place, mode));
  if (model != kFactoryVlp16 && model != kFactoryVlp32c)
    throw InputError(fmt::format("{}: expected model 22 (VLP-16) or 28 (VLP-32C), got {:02x}", place, model));
  packet.mode = static_cast<VelodynePacket::ReturnMode>(mode);
  packet.model = model == kFactoryVlp16 ? LidarModel::vlp16 : LidarModel::vlp32c;
  return packet;
}

std::vector<VelodynePacket> read_packets(const std::filesystem::path& path) {
  const std::string content = read_file(path);
  const std::vector<uint8_t> bytes(content.begin(), content.end());
  if (bytes.empty() || bytes.size() % VelodynePacket::kBytes != 0)
    throw InputError(fmt::format("{}: expected a whole number of packets of {} bytes, got {} bytes",
                                 path.string(), VelodynePacket::kBytes, bytes.size()));
  std::vector<VelodynePacket> packets;
  for (size_t i = 0; i * VelodynePacket::kBytes < bytes.size(); ++i)
    packets.push_back(
        decode_packet(std::span(bytes).subspan(i * VelodynePacket::kBytes, VelodynePacket::kBytes),
                      fmt::format("{}: packet {}", path.string(), i)));
  return packets;
}

namespace {

// Blocks in order of time with one return each. In dual mode the second of a pair is the strongest return.
std::vector<const VelodyneBlock*> single_blocks(std::span<const VelodynePacket> packets) {
  std::vector<const VelodyneBlock*> blocks;
  for (const VelodynePacket& packet : packets) {
    const bool dual = packet.mode == VelodynePacket::ReturnMode::dual;
    for (size_t b = dual ? 1 : 0; b < packet.blocks.size(); b += dual ? 2 : 1)
      blocks.push_back(&packet.blocks[b]);
  }
  return blocks;
}

}  // namespace

std::vector<VelodyneFiring> VelodyneDecoder::firings(std::span<const VelodynePacket> packets) const {
  constexpr double kRadPerCdeg = std::numbers::pi / 18000;
  const std::vector<const VelodyneBlock*> blocks = single_blocks(packets);
  const auto lasers = static_cast<int>(table_.lasers.size());
  std::vector<VelodyneFiring> firings;
  for (size_t b = 0; b + 1 < blocks.size(); ++b) {
    const int azimuth = blocks[b]->azimuth_cdeg,
              step = (blocks[b + 1]->azimuth_cdeg - azimuth + 36000) % 36000;
    for (int k = 0; k < table_.cycles_per_block; ++k) {
      for (int laser = 0; laser < lasers; ++laser) {
        const VelodyneChannel& channel = blocks[b]->channels[static_cast<size_t>(k * lasers + laser)];
        const Laser& mount = table_.lasers[static_cast<size_t>(laser)];
        const double share =
            (k + static_cast<double>(mount.fire_offset_ns) / static_cast<double>(table_.cycle_ns)) /
            table_.cycles_per_block;
        const double azimuth_rad = mount.azimuth_offset_rad - kRadPerCdeg * (azimuth + share * step);
        firings.push_back({static_cast<int64_t>(b) * table_.cycles_per_block + k, laser, azimuth_rad,
                           channel.range * table_.range_step_m, channel.reflectivity});
      }
    }
  }
  return firings;
}

std::vector<LidarScan> VelodyneDecoder::scans(std::span<const VelodynePacket> packets, Time first) const {
  const std::vector<const VelodyneBlock*> blocks = single_blocks(packets);
  const std::vector<VelodyneFiring> all = firings(packets);
  const size_t per_block = table_.lasers.size() * static_cast<size_t>(table_.cycles_per_block);
  std::vector<LidarScan> scans;
  bool whole = false;  // the recording rarely begins with a revolution
  LidarScan scan;
  for (size_t b = 0; b + 1 < blocks.size(); ++b) {
    const Time block_time = first + Duration{all[b * per_block].cycle * table_.cycle_ns};
    if (b > 0 && blocks[b]->azimuth_cdeg < blocks[b - 1]->azimuth_cdeg) {
      if (whole) scans.push_back(std::move(scan));
      scan = LidarScan{block_time, block_time, {}};
      whole = true;
    }
    for (size_t i = b * per_block; i < (b + 1) * per_block; ++i) {
      const VelodyneFiring& firing = all[i];
      const Laser& laser = table_.lasers[static_cast<size_t>(firing.laser)];
      scan.end = first + Duration{firing.cycle * table_.cycle_ns + laser.fire_offset_ns};
      if (firing.range_m == 0) continue;
      const double across = firing.range_m * std::cos(laser.elevation_rad);
      scan.points.push_back({static_cast<float>(across * std::cos(firing.azimuth_rad)),
                             static_cast<float>(across * std::sin(firing.azimuth_rad)),
                             static_cast<float>(firing.range_m * std::sin(laser.elevation_rad) + laser.dz_m),
                             static_cast<float>(firing.reflectivity), laser.ring,
                             static_cast<float>(seconds_between(scan.stamp, scan.end))});
    }
  }
  return scans;
}

}  // namespace vsslam

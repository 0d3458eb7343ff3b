#include "sensors/lidar/velodyne_packets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

#include "core/errors.h"
#include "sensors/lidar/lidar.h"
#include "tests/scratch.h"
#include "tests/sensors/shapes.h"
#include "tests/shared_data.h"

namespace vsslam {
namespace {

using ::testing::HasSubstr;
using ::testing::Property;
using ::testing::ThrowsMessage;

/// A packet whose channel c of block b has range 100 b + c + 1 and reflectivity c.
std::vector<uint8_t> packet_bytes(uint16_t first_azimuth_cdeg, uint8_t mode = 0x37, uint8_t model = 0x22,
                                  uint16_t azimuth_step_cdeg = 40) {
  std::vector<uint8_t> bytes(VelodynePacket::kBytes);
  const bool dual = mode == 0x39;
  for (size_t b = 0; b < 12; ++b) {
    const size_t turned = dual ? b / 2 : b;
    const auto azimuth = static_cast<uint16_t>((first_azimuth_cdeg + azimuth_step_cdeg * turned) % 36000);
    uint8_t* block = &bytes[100 * b];
    block[0] = 0xFF, block[1] = 0xEE;
    block[2] = static_cast<uint8_t>(azimuth & 0xFF), block[3] = static_cast<uint8_t>(azimuth >> 8);
    for (size_t c = 0; c < 32; ++c) {
      const auto range = static_cast<uint16_t>(100 * b + c + 1);
      block[4 + 3 * c] = static_cast<uint8_t>(range & 0xFF),
                    block[5 + 3 * c] = static_cast<uint8_t>(range >> 8);
      block[6 + 3 * c] = static_cast<uint8_t>(c);
    }
  }
  bytes[1200] = 0x78, bytes[1201] = 0x56, bytes[1202] = 0x34, bytes[1203] = 0x12;
  bytes[1204] = mode, bytes[1205] = model;
  return bytes;
}

TEST(VelodynePackets, DecodesEveryField) {
  const VelodynePacket packet = decode_packet(packet_bytes(35900), "here");
  EXPECT_EQ(packet.blocks[0].azimuth_cdeg, 35900);
  EXPECT_EQ(packet.blocks[11].azimuth_cdeg, 340);
  EXPECT_EQ(packet.blocks[7].channels[31].range, 732);
  EXPECT_EQ(packet.blocks[7].channels[31].reflectivity, 31);
  EXPECT_EQ(packet.stamp_us, 0x12345678u);
  EXPECT_EQ(packet.mode, VelodynePacket::ReturnMode::strongest);
  EXPECT_EQ(packet.model, LidarModel::vlp16);
  EXPECT_EQ(decode_packet(packet_bytes(0, 0x38, 0x28), "here").model, LidarModel::vlp32c);
}

TEST(VelodynePackets, BadBytesAreErrorsWithAPlace) {
  const auto fails = [](std::vector<uint8_t> bytes, const char* what) {
    EXPECT_THAT([&] { decode_packet(bytes, "file: packet 7"); }, ThrowsMessage<InputError>(HasSubstr(what)));
    EXPECT_THAT([&] { decode_packet(bytes, "file: packet 7"); },
                ThrowsMessage<InputError>(HasSubstr("file: packet 7")));
  };
  std::vector<uint8_t> bytes = packet_bytes(0);
  fails({bytes.begin(), bytes.end() - 1}, "1206 bytes");
  fails({}, "1206 bytes");
  fails(packet_bytes(0, 0x36), "return mode");
  fails(packet_bytes(0, 0x37, 0x21), "model");
  bytes[301] = 0xDD;
  fails(bytes, "block 3");
  bytes = packet_bytes(0);
  bytes[103] = 0xFF;
  fails(bytes, "azimuth");
}

TEST(VelodynePackets, TruncatedFilesAreErrors) {
  const std::string path = scratch_folder() / "packets.bin";
  const std::vector<uint8_t> bytes = packet_bytes(0);
  const auto write = [&](size_t size) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(size));
  };
  write(bytes.size());
  EXPECT_EQ(read_packets(path).size(), 1u);
  write(bytes.size() - 6);
  EXPECT_THROW(read_packets(path), InputError);
  write(0);
  EXPECT_THROW(read_packets(path), InputError);
  EXPECT_THROW(read_packets(path + ".absent"), InputError);
}

TEST(VelodynePackets, AzimuthIsInterpolatedOverTheWrap) {
  const VelodynePacket packet = decode_packet(packet_bytes(35980), "here");
  const std::vector<VelodyneFiring> firings = VelodyneDecoder(LidarModel::vlp16).firings({&packet, 1});
  ASSERT_EQ(firings.size(), 11u * 32);
  // Second cycle of the first block, laser 3: 359.8 deg + 0.4 deg * (1 + 6.912 / 55.296) / 2, range 20 steps.
  const VelodyneFiring& firing = firings[19];
  EXPECT_EQ(firing.laser, 3);
  EXPECT_EQ(firing.cycle, 1);
  EXPECT_NEAR(-firing.azimuth_rad * 180 / std::numbers::pi, 359.8 + 0.2 * (1 + 0.125), 1e-9);
  EXPECT_NEAR(firing.range_m, 0.04, 1e-12);
}

TEST(VelodynePackets, DualModeTakesTheStrongest) {
  const VelodynePacket packet = decode_packet(packet_bytes(100, 0x39), "here");
  const std::vector<VelodyneFiring> firings = VelodyneDecoder(LidarModel::vlp16).firings({&packet, 1});
  ASSERT_EQ(firings.size(), 5u * 32);
  EXPECT_NEAR(firings[0].range_m, 0.002 * 101, 1e-12);
  EXPECT_EQ(firings.back().cycle, 9);
}

TEST(VelodynePackets, ScansAreWholeRevolutions) {
  std::vector<VelodynePacket> packets;
  for (uint32_t i = 0; i < 200; ++i)
    packets.push_back(decode_packet(packet_bytes(static_cast<uint16_t>((20000 + 480 * i) % 36000)), "here"));
  const std::vector<LidarScan> scans = VelodyneDecoder(LidarModel::vlp16).scans(packets, Time{1'000'000'000});
  ASSERT_EQ(scans.size(), 2u);  // forward is passed three times
  EXPECT_EQ(scans[0].points.size(), 900u * 32);
  EXPECT_EQ(scans[0].stamp.ns, 1'000'000'000 + 400 * 2 * 55296);
  EXPECT_EQ(scans[0].end.ns, scans[0].stamp.ns + 1799 * 55296 + 34560);
}

// --- the model beside a real device at rest -----------------------------------------------------------

struct RestStatistics {
  double sigma_mm[3] = {};  ///< quartiles over beams
  size_t beams = 0;
  double return_share = 0;  ///< of all firings
  double step_mean_cdeg = 0, step_sigma_cdeg = 0;
};

/// Noise of a beam: same laser, same 0.2 deg of azimuth, all revolutions; ranges within 5 cm of the median.
RestStatistics rest_statistics(const std::vector<VelodyneFiring>& firings,
                               const std::vector<int>& azimuths_cdeg) {
  RestStatistics out;
  std::map<std::pair<int, int>, std::vector<double>> beams;
  size_t returns = 0;
  for (const VelodyneFiring& f : firings) {
    if (f.range_m == 0) continue;
    ++returns;
    const double turns = -f.azimuth_rad / (2 * std::numbers::pi);
    beams[{f.laser, static_cast<int>(1800 * (turns - std::floor(turns)))}].push_back(f.range_m);
  }
  out.return_share = static_cast<double>(returns) / static_cast<double>(firings.size());
  std::vector<double> sigmas;
  for (auto& [beam, ranges] : beams) {
    if (ranges.size() < 8) continue;
    std::sort(ranges.begin(), ranges.end());
    const double median = ranges[ranges.size() / 2];
    if (ranges.front() < median - 0.05 || ranges.back() > median + 0.05) continue;
    double mean = 0, sum2 = 0;
    for (double r : ranges) mean += r / static_cast<double>(ranges.size());
    for (double r : ranges) sum2 += (r - mean) * (r - mean);
    sigmas.push_back(1e3 * std::sqrt(sum2 / static_cast<double>(ranges.size() - 1)));
  }
  std::sort(sigmas.begin(), sigmas.end());
  out.beams = sigmas.size();
  for (size_t q = 0; q < 3 && !sigmas.empty(); ++q) out.sigma_mm[q] = sigmas[sigmas.size() * (q + 1) / 4];
  double sum = 0, sum2 = 0;
  const auto steps = static_cast<double>(azimuths_cdeg.size() - 1);
  for (size_t i = 1; i < azimuths_cdeg.size(); ++i) {
    const int step = (azimuths_cdeg[i] - azimuths_cdeg[i - 1] + 36000) % 36000;
    sum += step, sum2 += step * step;
  }
  out.step_mean_cdeg = sum / steps;
  out.step_sigma_cdeg = std::sqrt(sum2 / steps - out.step_mean_cdeg * out.step_mean_cdeg);
  return out;
}

void print(const char* name, const RestStatistics& s) {
  std::printf(
      "%-12s range sigma %.1f / %.1f / %.1f mm (quartiles of %zu beams), azimuth step %.2f +- %.2f cdeg, "
      "returns %.0f %%\n",
      name, s.sigma_mm[0], s.sigma_mm[1], s.sigma_mm[2], s.beams, s.step_mean_cdeg, s.step_sigma_cdeg,
      100 * s.return_share);
}

/// A furnished room with what swallows light: a window front, a black cabinet, a table within minimum range.
RestStatistics model_at_rest() {
  World world = shapes::room_world({-4, -3, -1}, {6, 5, 1.8}, 0.5f);
  world.materials.push_back(shapes::paint(0.05f));
  world.materials.push_back(shapes::paint(0.5f));
  world.materials[2].glass = true;
  shapes::add(world, shapes::quad({5.9, -2, -0.5}, {0, 5, 0}, {0, 0, 2}), "night", 1);
  shapes::add(world, shapes::quad({5.8, -2, -0.5}, {0, 5, 0}, {0, 0, 2}), "window", 2);
  shapes::add(world, shapes::quad({-3.9, -2, -1}, {0, 3, 0}, {0, 0, 2}), "cabinet", 1);
  shapes::add(world, shapes::quad({-0.7, -2, -0.4}, {0, 4, 0}, {0, 0, 0.6}), "screen", 0);
  const Raycaster raycaster(world);
  Lidar lidar({}, {}, 1, raycaster);
  const Trajectory rest = shapes::at_rest(SE3(), 1.5);
  std::vector<VelodyneFiring> firings;
  std::vector<int> azimuths_cdeg;
  Revolution revolution = lidar.power_on(Time{0});
  for (int k = 0; k < 13; ++k, revolution = lidar.after(revolution)) {
    const LidarMeasurement m = lidar.scan(revolution, rest, SE3());
    std::vector<VelodyneFiring> all(static_cast<size_t>(16 * revolution.cycles));
    for (const LidarPoint& p : m.scan.points) {
      const auto tick = static_cast<int64_t>(std::lround(p.time_s / 2.304e-6));
      const int64_t cycle = tick / 24, laser = tick % 24;
      const double dz = laser_table(LidarModel::vlp16).lasers[static_cast<size_t>(laser)].dz_m;
      all[static_cast<size_t>(16 * cycle + laser)] = {cycle, static_cast<int>(laser), std::atan2(p.y, p.x),
                                                      std::hypot(p.x, p.y, p.z - dz), 0};
      // The azimuth of a block is that of laser 0 in its first cycle.
      if (laser == 0 && (revolution.first_cycle + cycle) % 2 == 0) {
        const double turns = -std::atan2(p.y, p.x) / (2 * std::numbers::pi);
        azimuths_cdeg.push_back(static_cast<int>(std::lround(36000 * (turns - std::floor(turns)))) % 36000);
      }
    }
    firings.insert(firings.end(), all.begin(), all.end());
  }
  // Blocks without a return of laser 0 leave steps of two and more; they do not count.
  RestStatistics s = rest_statistics(firings, azimuths_cdeg);
  std::vector<double> steps;
  for (size_t i = 1; i < azimuths_cdeg.size(); ++i) {
    const int step = (azimuths_cdeg[i] - azimuths_cdeg[i - 1] + 36000) % 36000;
    if (step < 60) steps.push_back(step);
  }
  double sum = 0, sum2 = 0;
  for (double step : steps) sum += step, sum2 += step * step;
  const auto n = static_cast<double>(steps.size());
  s.step_mean_cdeg = sum / n;
  s.step_sigma_cdeg = std::sqrt(sum2 / n - s.step_mean_cdeg * s.step_mean_cdeg);
  return s;
}

// What a real VLP-16 at rest showed (see docs/sensors.md): sigma 5.8 / 6.9 / 8.5 mm, step 39.81 +- 0.83 cdeg.
TEST(RealPackets, TheDefaultModelIsLikeARecordedVlp16) {
  const RestStatistics s = model_at_rest();
  print("model", s);
  EXPECT_NEAR(s.sigma_mm[1], 6.9, 1.0);
  EXPECT_NEAR(s.step_mean_cdeg, 39.81, 0.02);
  EXPECT_NEAR(s.step_sigma_cdeg, 0.83, 0.1);
  EXPECT_LT(s.return_share, 0.95);
}

TEST(RealPackets, ARecordingAgreesWithTheModel) {
  const std::filesystem::path file = shared_packets();
  if (file.empty()) GTEST_SKIP() << "set VSSLAM_VLP16_PACKETS to a file of raw packets";
  const std::vector<VelodynePacket> packets = read_packets(file);
  std::vector<int> azimuths_cdeg;
  for (const VelodynePacket& packet : packets)
    for (const VelodyneBlock& block : packet.blocks) azimuths_cdeg.push_back(block.azimuth_cdeg);
  const RestStatistics real =
      rest_statistics(VelodyneDecoder(LidarModel::vlp16).firings(packets), azimuths_cdeg);
  const RestStatistics model = model_at_rest();
  print("recording", real);
  print("model", model);
  EXPECT_NEAR(model.sigma_mm[1], real.sigma_mm[1], 1.5);
  EXPECT_NEAR(model.step_mean_cdeg, real.step_mean_cdeg, 0.05);
  EXPECT_NEAR(model.step_sigma_cdeg, real.step_sigma_cdeg, 0.15);
  EXPECT_FALSE(VelodyneDecoder(LidarModel::vlp16).scans(packets, Time{0}).empty());
}

}  // namespace
}  // namespace vsslam

#include "scenarios/datasets/import/packet_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/datasets/import/open_recording.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int64_t kPacketNs = 1'327'104;       // 24 firing cycles
constexpr uint32_t kFirst_us = 3'599'950'000;  // past the hour: it is over 50 ms later

void put_u16(std::string& bytes, int value) {
  bytes += static_cast<char>(value & 0xFF);
  bytes += static_cast<char>(value >> 8);
}

/// Packet `i` of a VLP-16 that turns by 0.4 degrees a block and sees everything at 5 m.
std::string packet(int i) {
  std::string bytes;
  for (int b = 0; b < 12; ++b) {
    bytes += "\xFF\xEE";
    put_u16(bytes, (20000 + 40 * (12 * i + b)) % 36000);
    for (int c = 0; c < 32; ++c) {
      put_u16(bytes, 2500);
      bytes += '\x10';
    }
  }
  const auto us = static_cast<uint32_t>((kFirst_us + (int64_t{i} * kPacketNs + 500) / 1000) % 3'600'000'000);
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(us >> 8 * k);
  return bytes + "\x37\x22";
}

std::string little(uint64_t value, int count) {
  std::string bytes;
  for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> 8 * k);
  return bytes;
}

/// Ethernet, IPv4, UDP.
std::string frame(const std::string& payload, uint16_t port) {
  const auto big = [](size_t v) { return std::string{static_cast<char>(v >> 8), static_cast<char>(v)}; };
  std::string ip = "\x45";
  ip += '\0';
  ip += big(20 + 8 + payload.size()) + std::string(4, '\0') + '\x40' + '\x11' + std::string(10, '\0');
  return std::string(12, '\1') + "\x08" + '\0' + ip + big(port) + big(port) + big(8 + payload.size()) +
         std::string(2, '\0') + payload;
}

std::string pcap(const std::vector<std::pair<int64_t, std::string>>& frames) {
  std::string bytes =
      little(0xA1B2C3D4, 4) + little(2, 2) + little(4, 2) + little(0, 8) + little(65535, 4) + little(1, 4);
  for (const auto& [us, content] : frames) {
    const auto size = static_cast<uint32_t>(content.size());
    bytes += little(static_cast<uint32_t>(us / 1'000'000), 4) +
             little(static_cast<uint32_t>(us % 1'000'000), 4) + little(size, 4) + little(size, 4) + content;
  }
  return bytes;
}

std::vector<LidarScan> scans_of(const std::string& bytes, const char* name,
                                const RecordingOptions& options = {}) {
  const std::filesystem::path path = scratch_folder() / name;
  write_file(path, bytes);
  const auto recording = open_recording(path, RigSheet{}, options);
  std::vector<LidarScan> scans;
  while (auto sample = recording->next()) scans.push_back(std::get<LidarScan>(sample->sample));
  return scans;
}

std::string packets(int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) bytes += packet(i);
  return bytes;
}

TEST(PacketRecording, CutsWholeRevolutions) {
  const std::vector<LidarScan> scans = scans_of(packets(260), "a.bin");
  ASSERT_EQ(scans.size(), 3u);  // forward is passed four times
  for (const LidarScan& scan : scans) {
    EXPECT_EQ(scan.points.size(), 900u * 32);
    EXPECT_NEAR(seconds_between(scan.stamp, scan.end), 0.0995, 0.0002);
  }
  // The first begins 160 degrees after the first packet, the others a turn of 75 packets after one another; the hour is
  // over on the way. Stamps are whole microseconds.
  EXPECT_NEAR(1e-3 * static_cast<double>(scans[0].stamp.ns), kFirst_us + 400 / 12.0 * kPacketNs / 1000.0, 2);
  EXPECT_NEAR(static_cast<double>((scans[2].stamp - scans[1].stamp).ns), 75.0 * kPacketNs, 2000);
}

TEST(PacketRecording, LeavesOutRevolutionsWithMissingPackets) {
  std::string bytes = packets(260);
  bytes.erase(150 * VelodynePacket::kBytes, 20 * VelodynePacket::kBytes);
  EXPECT_EQ(scans_of(bytes, "b.bin").size(), 2u);  // passed forward at packets 33, 108, (183), 183 and 258
}

TEST(PacketRecording, ReadsNetworkCaptures) {
  constexpr int64_t kHour_us = 3'600'000'000;
  const int64_t received = 472'222 * kHour_us + kFirst_us;
  std::vector<std::pair<int64_t, std::string>> frames;
  for (int i = 0; i < 200; ++i) {
    frames.emplace_back(received + i * 1327, frame(packet(i), 2368));
    if (i % 20 == 0) frames.emplace_back(received + i * 1327, frame(std::string(512, 'p'), 8308));
  }
  const std::string bytes = pcap(frames);
  const std::vector<LidarScan> scans = scans_of(bytes, "c.pcap"), plain = scans_of(packets(200), "c.bin");
  ASSERT_EQ(scans.size(), plain.size());
  EXPECT_EQ(scans[0].stamp - plain[0].stamp, Duration{472'222 * kHour_us * 1000});
  EXPECT_EQ(scans[1].points[77].x, plain[1].points[77].x);
}

TEST(PacketRecording, BrokenFilesAreErrorsOrSalvaged) {
  const std::string whole = packets(260);
  const std::string cut = whole.substr(0, whole.size() - 7);
  EXPECT_THAT([&] { scans_of(cut, "d.bin"); }, ThrowsMessage<InputError>(HasSubstr("d.bin: packet 259")));
  EXPECT_EQ(scans_of(cut, "d.bin", {.salvage = true}).size(), 3u);
  std::vector<std::pair<int64_t, std::string>> frames;
  for (int i = 0; i < 260; ++i) frames.emplace_back(i * 1327, frame(packet(i), 2368));
  const std::string capture = pcap(frames), cut_capture = capture.substr(0, capture.size() - 100);
  EXPECT_THAT([&] { scans_of(cut_capture, "e.pcap"); },
              ThrowsMessage<InputError>(HasSubstr("after frame 259")));
  EXPECT_EQ(scans_of(cut_capture, "e.pcap", {.salvage = true}).size(), 3u);
}

TEST(PacketRecording, TheSheetMustBeOfThisLidar) {
  write_file(scratch_folder() / "f.bin", packets(3));
  RigSheet sheet;
  sheet.calibration.lidar.rings = 32;
  const auto recording = open_recording(scratch_folder() / "f.bin", sheet, {});
  EXPECT_THAT([&] { recording->next(); }, ThrowsMessage<InputError>(HasSubstr("16 rings")));
}

}  // namespace
}  // namespace vsslam

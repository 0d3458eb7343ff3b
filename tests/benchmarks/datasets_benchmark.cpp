// Bags and MCAP files of one VLP-16 and one IMU, in times real time: seconds of recording per second of one core.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <numbers>

#include "core/rng.h"
#include "scenarios/datasets/formats/message_file.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

constexpr int kScans = 100;     // at 10 Hz
constexpr int kColumns = 1808;  // of 16 lasers, all with a return

void append(PointCloudMessage& cloud, const void* value, size_t size) {
  const auto* bytes = static_cast<const uint8_t*>(value);
  cloud.data.insert(cloud.data.end(), bytes, bytes + size);
}

/// A round room of 8 m radius as seen with 7 mm of noise and 2 mm steps.
PointCloudMessage room_scan(uint64_t scan) {
  const RandomStream noise(scan, "room");
  PointCloudMessage cloud;
  cloud.fields = {
      {"x", 0},    {"y", 4}, {"z", 8}, {"intensity", 12}, {"ring", 16, PointCloudMessage::Field::u16},
      {"time", 18}};
  cloud.point_step = 22;
  for (int i = 0; i < 16 * kColumns; ++i) {
    const double azimuth_rad = 2 * std::numbers::pi * (i / 16) / kColumns;
    const double elevation_rad = (2.0 * (i % 16) - 15.0) * std::numbers::pi / 180;
    const double range_m = std::round((8 + 0.007 * noise.normal(static_cast<uint64_t>(i))) / 0.002) * 0.002;
    const float values[] = {static_cast<float>(range_m * std::cos(elevation_rad) * std::cos(azimuth_rad)),
                            static_cast<float>(range_m * std::cos(elevation_rad) * std::sin(azimuth_rad)),
                            static_cast<float>(range_m * std::sin(elevation_rad)),
                            static_cast<float>(i % 97)};
    const auto ring = static_cast<uint16_t>(i % 16);
    const auto time_s = static_cast<float>(0.1 * i / (16 * kColumns));
    append(cloud, values, sizeof values);
    append(cloud, &ring, sizeof ring);
    append(cloud, &time_s, sizeof time_s);
  }
  cloud.width = 16 * kColumns;
  cloud.row_step = cloud.width * cloud.point_step;
  return cloud;
}

using Open = std::unique_ptr<MessageWriter> (*)(const fs::path&);

void write_drive(Open open, const fs::path& path, const std::vector<Message>& scans) {
  const auto writer = open(path);
  for (int i = 0; i < kScans; ++i) {
    Message scan = scans[static_cast<size_t>(i) % scans.size()];
    scan.recorded = Time{1'700'000'000'000'000'000 + int64_t{100'000'000} * i};
    writer->write(scan);
    for (int k = 0; k < 10; ++k)
      writer->write({"/imu/data", scan.recorded + Duration{10'000'000} * k, ImuMessage{}});
  }
  writer->finish();
}

std::vector<Message> some_scans() {
  std::vector<Message> scans;
  for (uint64_t i = 0; i < 5; ++i) scans.push_back({"/velodyne_points", {}, room_scan(i)});
  return scans;
}

fs::path scratch(const char* name) {
  return fs::temp_directory_path() / fmt::format("vsslam_{}_{}", ::getpid(), name);
}

void count_drive(benchmark::State& state, const fs::path& path) {
  state.counters["real_time_factor"] =
      benchmark::Counter(0.1 * kScans * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["mb_per_scan"] = static_cast<double>(fs::file_size(path)) / 1e6 / kScans;
  fs::remove(path);
}

void write(benchmark::State& state, Open open) {
  const std::vector<Message> scans = some_scans();
  const fs::path path = scratch("written");
  for (auto _ : state) write_drive(open, path, scans);
  count_drive(state, path);
}
BENCHMARK_CAPTURE(write, bag, write_bag)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write, mcap, write_mcap)->Unit(benchmark::kMillisecond);

void read(benchmark::State& state, Open open) {
  const fs::path path = scratch("read");
  write_drive(open, path, some_scans());
  for (auto _ : state) {
    const auto reader = read_messages(path);
    while (const auto message = reader->next()) benchmark::DoNotOptimize(message);
  }
  count_drive(state, path);
}
BENCHMARK_CAPTURE(read, bag, write_bag)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, mcap, write_mcap)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vsslam

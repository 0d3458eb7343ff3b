#include "sensors/lidar/laser_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vsslam {

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr int64_t kFiringNs = 2'304;

// Velodyne VLP-32C: azimuth offset and elevation in degrees by laser id, as the public driver's calibration
// file lists them.
constexpr std::array<std::array<double, 2>, 32> kVlp32cDeg = {{
    {-1.4, -25},    {4.2, -1},     {-1.4, -1.667}, {1.4, -15.639}, {-1.4, -11.31}, {1.4, 0},
    {-4.2, -0.667}, {1.4, -8.843}, {-1.4, -7.254}, {4.2, 0.333},   {-1.4, -0.333}, {1.4, -6.148},
    {-4.2, -5.333}, {1.4, 1.333},  {-4.2, 0.667},  {1.4, -4},      {-1.4, -4.667}, {4.2, 1.667},
    {-1.4, 1},      {4.2, -3.667}, {-4.2, -3.333}, {1.4, 3.333},   {-1.4, 2.333},  {1.4, -2.667},
    {-1.4, -3},     {1.4, 7},      {-1.4, 4.667},  {4.2, -2.333},  {-4.2, -2},     {1.4, 15},
    {-1.4, 10.333}, {1.4, -1.333},
}};

void number_rings(std::vector<Laser>& lasers) {
  for (Laser& laser : lasers)
    laser.ring = static_cast<uint16_t>(std::count_if(lasers.begin(), lasers.end(), [&](const Laser& other) {
      return other.elevation_rad < laser.elevation_rad;
    }));
}

// Even ids look down from -15 deg, odd ones up from +1 deg, 2 deg apart. dz in millimetres is rounded to a
// tenth, as the device's own tables have it.
LaserTable make_vlp16() {
  LaserTable table;
  for (int id = 0; id < 16; ++id) {
    const double elevation_rad = (id % 2 == 0 ? id - 15 : id) * kRadPerDeg;
    const double dz_mm = -1e3 * table.origin_offset_m * std::tan(elevation_rad);
    table.lasers.push_back({elevation_rad, 0, 1e-3 * std::round(10 * dz_mm) / 10, kFiringNs * id, 0});
  }
  number_rings(table.lasers);
  return table;
}

// Lasers fire in pairs.
LaserTable make_vlp32c() {
  LaserTable table;
  table.origin_offset_m = 0.0424;
  table.range_step_m = 0.004;
  table.cycles_per_block = 1;
  for (size_t id = 0; id < kVlp32cDeg.size(); ++id) {
    const double elevation_rad = kVlp32cDeg[id][1] * kRadPerDeg;
    const double dz_m = -table.origin_offset_m * std::tan(elevation_rad);
    table.lasers.push_back(
        {elevation_rad, kVlp32cDeg[id][0] * kRadPerDeg, dz_m, kFiringNs * static_cast<int64_t>(id / 2), 0});
  }
  number_rings(table.lasers);
  return table;
}

}  // namespace

const LaserTable& laser_table(LidarModel model) {
  static const LaserTable vlp16 = make_vlp16();
  static const LaserTable vlp32c = make_vlp32c();
  return model == LidarModel::vlp16 ? vlp16 : vlp32c;
}

}  // namespace vsslam

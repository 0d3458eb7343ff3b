#include "scenarios/datasets/import/decoders/ring_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensors/lidar/laser_table.h"
#include "slam/lidar/ring_bands.h"

namespace vsslam {

namespace {

std::vector<double> elevations_of(LidarModel model) {
  std::vector<double> elevations;
  for (const Laser& laser : laser_table(model).lasers) elevations.push_back(laser.elevation_rad);
  std::sort(elevations.begin(), elevations.end());
  return elevations;
}

// The optical centre is not the origin, so near points are off by a little.
bool fits(const std::vector<double>& table, const std::vector<double>& seen) {
  constexpr double kOff = 0.3 * std::numbers::pi / 180;
  const auto on = std::count_if(seen.begin(), seen.end(),
                                [&](double e) { return std::abs(table[nearest(table, e)] - e) < kOff; });
  return on >= 0.9 * static_cast<double>(seen.size());
}

bool is_ring(double ring, int most_rings) {
  return ring >= 0 && ring < most_rings && ring == std::floor(ring);
}

}  // namespace

std::optional<std::string> fault_of_rings(const std::vector<LidarPoint>& points,
                                          const std::vector<double>& rings, int most_rings) {
  if (points.empty()) return std::nullopt;
  size_t wrong = 0, example = 0;
  for (size_t i = 0; i < rings.size(); ++i)
    if (!is_ring(rings[i], most_rings) && wrong++ == 0) example = i;
  if (wrong * 100 > rings.size())
    return fmt::format("rings that there are not (such as {}, of {})", rings[example], most_rings);
  if (std::any_of(rings.begin(), rings.end(), [&](double ring) { return ring != rings.front(); }))
    return std::nullopt;
  if (at_one_elevation(points)) return std::nullopt;
  return fmt::format("all points are of ring {}", rings.front());
}

void RingFinder::learn(const std::vector<LidarPoint>& points) {
  std::vector<double> seen;
  for (const LidarPoint& p : points) seen.push_back(elevation_rad(p));
  for (const LidarModel model : {LidarModel::vlp16, LidarModel::vlp32c}) {
    const std::vector<double> table = elevations_of(model);
    if (static_cast<int>(table.size()) == rings_ && fits(table, seen)) elevations_rad_ = table;
  }
  if (elevations_rad_.empty()) elevations_rad_ = gathered(seen);
  clean_ = !elevations_rad_.empty();
  if (clean_) return;
  const auto [low, high] = std::minmax_element(seen.begin(), seen.end());
  for (int ring = 0; ring < rings_; ++ring)
    elevations_rad_.push_back(*low + (*high - *low) * ring / std::max(1, rings_ - 1));
}

bool RingFinder::fill(std::vector<LidarPoint>& points) {
  if (points.empty()) return false;
  if (elevations_rad_.empty()) learn(points);
  for (LidarPoint& p : points) p.ring = static_cast<uint16_t>(nearest(elevations_rad_, elevation_rad(p)));
  return clean_;
}

}  // namespace vsslam

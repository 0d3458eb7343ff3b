#include "scenarios/datasets/ring_finder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sensors/laser_table.h"

namespace vsslam {

namespace {

double elevation_rad(const LidarPoint& p) {
  return std::atan2(static_cast<double>(p.z), std::hypot(static_cast<double>(p.x), static_cast<double>(p.y)));
}

size_t nearest(const std::vector<double>& ascending, double value) {
  const auto after = std::lower_bound(ascending.begin(), ascending.end(), value);
  const auto index = static_cast<size_t>(after - ascending.begin());
  if (index == ascending.size()) return index - 1;
  if (index > 0 && value - ascending[index - 1] <= ascending[index] - value) return index - 1;
  return index;
}

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

}  // namespace

void RingFinder::learn(const std::vector<LidarPoint>& points) {
  std::vector<double> seen;
  for (const LidarPoint& p : points) seen.push_back(elevation_rad(p));
  for (const LidarModel model : {LidarModel::vlp16, LidarModel::vlp32c}) {
    const std::vector<double> table = elevations_of(model);
    if (static_cast<int>(table.size()) == rings_ && fits(table, seen)) elevations_rad_ = table;
  }
  if (!elevations_rad_.empty()) return;
  const auto [low, high] = std::minmax_element(seen.begin(), seen.end());
  for (int ring = 0; ring < rings_; ++ring)
    elevations_rad_.push_back(*low + (*high - *low) * ring / std::max(1, rings_ - 1));
}

void RingFinder::fill(std::vector<LidarPoint>& points) {
  if (points.empty()) return;
  if (elevations_rad_.empty()) learn(points);
  for (LidarPoint& p : points) p.ring = static_cast<uint16_t>(nearest(elevations_rad_, elevation_rad(p)));
}

}  // namespace vsslam

#include "slam/lidar/ring_bands.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace vsslam {

double elevation_rad(const LidarPoint& p) {
  return std::atan2(static_cast<double>(p.z), std::hypot(static_cast<double>(p.x), static_cast<double>(p.y)));
}

bool at_one_elevation(const std::vector<LidarPoint>& points) {
  constexpr double kFlat_rad = std::numbers::pi / 180;
  if (points.empty()) return true;
  double low = elevation_rad(points.front()), high = low;
  for (const LidarPoint& p : points) {
    const double elevation = elevation_rad(p);
    low = std::min(low, elevation);
    high = std::max(high, elevation);
  }
  return high - low < kFlat_rad;
}

bool rings_tell(const std::vector<LidarPoint>& points) {
  const auto other = [&](const LidarPoint& p) { return p.ring != points.front().ring; };
  return std::any_of(points.begin(), points.end(), other) || at_one_elevation(points);
}

size_t nearest(const std::vector<double>& ascending, double value) {
  const auto after = std::lower_bound(ascending.begin(), ascending.end(), value);
  const auto index = static_cast<size_t>(after - ascending.begin());
  if (index == ascending.size()) return index - 1;
  if (index > 0 && value - ascending[index - 1] <= ascending[index] - value) return index - 1;
  return index;
}

std::vector<double> gathered(std::vector<double> elevations_rad) {
  constexpr size_t kMost = 128, kEach = 10;
  constexpr double kClean = 3;
  std::sort(elevations_rad.begin(), elevations_rad.end());
  std::vector<double> gaps;
  for (size_t i = 1; i < elevations_rad.size(); ++i) gaps.push_back(elevations_rad[i] - elevations_rad[i - 1]);
  std::sort(gaps.begin(), gaps.end(), std::greater<>());
  size_t between = 0;  // gaps that are none within a band
  double most = kClean;
  for (size_t k = 1; k < std::min(kMost, gaps.size()) && (k + 1) * kEach <= elevations_rad.size(); ++k)
    if (const double ratio = gaps[k - 1] / std::max(gaps[k], 1e-6); ratio > most) most = ratio, between = k;
  if (between == 0) return {};
  std::vector<double> means;
  size_t begin = 0;
  for (size_t i = 1; i <= elevations_rad.size(); ++i) {
    if (i < elevations_rad.size() && elevations_rad[i] - elevations_rad[i - 1] < gaps[between - 1]) continue;
    if (elevations_rad[i - 1] - elevations_rad[begin] > gaps[between - 1] / 2) return {};
    double sum = 0;
    for (size_t k = begin; k < i; ++k) sum += elevations_rad[k];
    means.push_back(sum / static_cast<double>(i - begin));
    begin = i;
  }
  return means;
}

bool RingBands::fill(std::vector<LidarPoint>& points) {
  if (points.empty()) return false;
  if (!learnt_) {
    std::vector<double> elevations;
    for (const LidarPoint& p : points) elevations.push_back(elevation_rad(p));
    bands_rad_ = gathered(std::move(elevations));
    learnt_ = true;
  }
  if (bands_rad_.empty()) return false;
  for (LidarPoint& p : points) p.ring = static_cast<uint16_t>(nearest(bands_rad_, elevation_rad(p)));
  return true;
}

}  // namespace vsslam

#include "scenarios/datasets/scan_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace vsslam {

namespace {

template <class T>
void permute(std::vector<T>& values, const std::vector<uint32_t>& order) {
  if (values.size() != order.size()) return;
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const uint32_t i : order) sorted.push_back(std::move(values[i]));
  values = std::move(sorted);
}

}  // namespace

void arrange_in_columns(LidarMeasurement& measurement, const LaserTable& table) {
  const std::vector<LidarPoint>& points = measurement.scan.points;
  // Firings are 2.3 us apart; times as float are right to 4 ns.
  const auto cycle = [&](const LidarPoint& p) {
    return std::llround(static_cast<double>(p.time_s) * 1e9 + 500) / table.cycle_ns;
  };
  std::vector<uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  for (size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    while (end < points.size() && cycle(points[end]) == cycle(points[begin])) ++end;
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin),
               last = order.begin() + static_cast<std::ptrdiff_t>(end);
    std::stable_sort(first, last, [&](uint32_t a, uint32_t b) { return points[a].ring < points[b].ring; });
    if (end == points.size() && points[order.back()].time_s < points.back().time_s)
      std::iota(first, last, static_cast<uint32_t>(begin));
  }
  permute(measurement.truth, order);
  permute(measurement.scan.points, order);
}

}  // namespace vsslam

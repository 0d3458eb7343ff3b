#include "scenarios/datasets/export/scan_columns.h"

#include <algorithm>
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
    return static_cast<int64_t>(static_cast<double>(p.time_s) * 1e9 + 500) / table.cycle_ns;
  };
  std::vector<uint32_t> order(points.size());
  std::vector<size_t> place(table.lasers.size() + 1);  // of each ring's next point
  for (size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    std::fill(place.begin(), place.end(), 0);
    for (const int64_t now = cycle(points[begin]); end < points.size() && cycle(points[end]) == now; ++end)
      ++place[points[end].ring + 1u];
    std::partial_sum(place.begin(), place.end(), place.begin());
    for (size_t i = begin; i < end; ++i) order[begin + place[points[i].ring]++] = static_cast<uint32_t>(i);
    if (end == points.size() && points[order.back()].time_s < points.back().time_s)
      std::iota(order.begin() + static_cast<std::ptrdiff_t>(begin), order.end(),
                static_cast<uint32_t>(begin));
  }
  permute(measurement.truth, order);
  permute(measurement.scan.points, order);
}

}  // namespace vsslam

#include "slam/lidar/ring_order.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vsslam {

namespace {

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What a step from firing to firing is: the median of those there are. Not the shortest, which may be a second return;
// a gap or two do not move it.
float usual_step(const RingOrder& order, const std::vector<float>& place) {
  constexpr size_t kSampled = 4096;  // steps: enough for a median good to a percent
  const size_t stride = std::max<size_t>(1, place.size() / kSampled);
  std::vector<float> steps;
  steps.reserve(place.size() / stride + 1);
  for (size_t ring = 0; ring < order.rings(); ++ring)
    for (size_t i = order.begin[ring] + 1; i < order.begin[ring + 1]; i += stride)
      if (const float step = place[i] - place[i - 1]; step > 0) steps.push_back(step);
  return steps.empty() ? 0 : median(steps);
}

// Times order the firings if few steps are much shorter than the usual one.
bool times_order(const RingOrder& order, const std::vector<float>& time_s, float period_s) {
  if (period_s <= 0) return false;
  constexpr float kShort = 0.5f;     // of a step: between 0 (a second return) and 1
  constexpr double kMostShort = 0.1; // second returns are a few percent; of jittered times about a third are short
  size_t shorter = 0;
  for (size_t ring = 0; ring < order.rings(); ++ring)
    for (size_t i = order.begin[ring] + 1; i < order.begin[ring + 1]; ++i)
      shorter += time_s[i] - time_s[i - 1] < kShort * period_s;
  return static_cast<double>(shorter) <= kMostShort * static_cast<double>(time_s.size());
}

}  // namespace

RingOrder::RingOrder(const LidarScan& scan, const Cloud& undistorted_lidar, double jump_m) {
  sort_by_ring(scan);
  std::vector<float> place(index.size());
  for (size_t i = 0; i < index.size(); ++i) place[i] = scan.points[index[i]].time_s;
  float period = usual_step(*this, place);
  if (!times_order(*this, place, period)) {
    sort_by_azimuth(scan);
    for (size_t i = 0; i < index.size(); ++i) {
      const LidarPoint& p = scan.points[index[i]];
      place[i] = -std::atan2(p.y, p.x);  // clockwise
    }
    period = usual_step(*this, place);
  }
  firing.resize(index.size());
  const float inverse_period = period > 0 ? 1 / period : 0;
  for (size_t ring = 0; ring < rings(); ++ring)
    for (size_t i = begin[ring]; i < begin[ring + 1]; ++i)
      firing[i] = (place[i] - place[begin[ring]]) * inverse_period;
  drop_repeated_firings();
  fill(scan, undistorted_lidar, static_cast<float>(jump_m));
  measure_step();
}

void RingOrder::sort_by_ring(const LidarScan& scan) {
  size_t rings = 0;
  for (const LidarPoint& p : scan.points) rings = std::max<size_t>(rings, p.ring + 1u);
  begin.assign(rings + 1, 0);
  for (const LidarPoint& p : scan.points) ++begin[p.ring + 1u];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<uint32_t> next = begin;
  index.resize(scan.points.size());
  for (uint32_t i = 0; i < scan.points.size(); ++i) index[next[scan.points[i].ring]++] = i;
}

void RingOrder::sort_by_azimuth(const LidarScan& scan) {
  std::vector<float> azimuth(scan.points.size());
  for (size_t i = 0; i < azimuth.size(); ++i) azimuth[i] = -std::atan2(scan.points[i].y, scan.points[i].x);
  for (size_t ring = 0; ring < rings(); ++ring)
    std::stable_sort(index.begin() + begin[ring], index.begin() + begin[ring + 1],
                     [&](uint32_t a, uint32_t b) { return azimuth[a] < azimuth[b]; });
}

void RingOrder::drop_repeated_firings() {
  constexpr float kSame = 0.5f;  // of a step
  size_t kept = 0, from = 0;
  for (size_t ring = 0; ring < rings(); ++ring) {
    const size_t to = begin[ring + 1], first = kept;
    for (size_t i = from; i < to; ++i) {
      if (kept > first && firing[i] - firing[kept - 1] < kSame) continue;
      index[kept] = index[i];
      firing[kept++] = firing[i];
    }
    begin[ring + 1] = static_cast<uint32_t>(kept);
    from = to;
  }
  index.resize(kept);
  firing.resize(kept);
}

void RingOrder::fill(const LidarScan& scan, const Cloud& undistorted_lidar, float jump_m) {
  const size_t n = index.size();
  ring.resize(n);
  range_m.resize(n);
  shadowed.assign(n, 0);
  points_lidar.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const LidarPoint& p = scan.points[index[i]];
    ring[i] = p.ring;
    range_m[i] = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    points_lidar[i] = undistorted_lidar[index[i]];
  }
  steps.assign(n + 1, 0);
  for (size_t i = 1; i < n; ++i)
    steps[i] = steps[i - 1] + (std::abs(range_m[i] - range_m[i - 1]) > jump_m ? 1 : 0);
}

void RingOrder::measure_step() {
  constexpr size_t kSampled = 1024;
  const size_t stride = std::max<size_t>(1, index.size() / kSampled);
  std::vector<float> angles_rad;
  for (size_t ring = 0; ring < rings(); ++ring)
    for (size_t i = begin[ring] + 1; i < begin[ring + 1]; i += stride) {
      if (firing[i] - firing[i - 1] > 1.5f) continue;
      const float sine = points_lidar[i].cross(points_lidar[i - 1]).norm() / (range_m[i] * range_m[i - 1]);
      angles_rad.push_back(std::asin(std::min(sine, 1.0f)));
    }
  if (!angles_rad.empty()) step_rad = median(angles_rad);
}

double measured_range_sigma_m(const RingOrder& order) {
  constexpr size_t kLeast = 100;  // windows: a median good to ten percent
  constexpr float kGap = 4.5f;    // firings from first to last of four neighbours
  std::vector<float> differences;
  differences.reserve(order.index.size() / 4);
  for (size_t ring = 0; ring < order.rings(); ++ring)
    for (size_t i = order.begin[ring]; i + 3 < order.begin[ring + 1]; i += 4) {
      if (order.steps[i + 3] != order.steps[i] || order.firing[i + 3] - order.firing[i] > kGap) continue;
      const float* r = &order.range_m[i];
      differences.push_back(std::abs(r[3] - 3 * r[2] + 3 * r[1] - r[0]));
    }
  if (differences.size() < kLeast) return 0;
  const double root_of_squares = std::sqrt(1.0 + 9 + 9 + 1), sigma_per_median = 1.4826;  // of a normal distribution
  return sigma_per_median * static_cast<double>(median(differences)) / root_of_squares;
}

}  // namespace vsslam

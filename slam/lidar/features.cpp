#include "slam/lidar/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "slam/lidar/voxel_hash.h"

namespace vsslam {

void FeatureConfig::fields(Fields& f) {
  f("half_window", half_window, between(1, 50));
  f("short_half_window", short_half_window, between(1, 50));
  f("planar_threshold_m", planar_threshold_m, positive());
  f("occlusion_jump_m", occlusion_jump_m, positive());
  f("occlusion_neighbours", occlusion_neighbours, between(0, 50));
  f("parallel_beam_deg", parallel_beam_deg, between(0, 90));
  f("min_range_m", min_range_m, non_negative());
  f.check(short_half_window <= half_window, "short_half_window", "at most half_window");
}

namespace {

// One ring, in order of time. Prefix sums make the mean over any window O(1).
struct Ring {
  std::vector<uint32_t> index;  // into scan.points
  std::vector<float> range_m, time_s;
  std::vector<Vec3> prefix_lidar;  // sum of the points before i
  std::vector<uint8_t> shadowed;

  void clear() {
    index.clear();
    range_m.clear();
    time_s.clear();
    prefix_lidar.assign(1, Vec3::Zero());
    shadowed.clear();
  }
  void push(uint32_t i, const LidarPoint& p, const Eigen::Vector3f& point_lidar) {
    index.push_back(i);
    range_m.push_back(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z));
    time_s.push_back(p.time_s);
    prefix_lidar.push_back(prefix_lidar.back() + point_lidar.cast<double>());
    shadowed.push_back(0);
  }
  size_t size() const { return index.size(); }
};

// Time between two firings of a laser: the shortest step in any ring.
float firing_period_s(const std::vector<Ring>& rings) {
  float period_s = std::numeric_limits<float>::max();
  for (const Ring& ring : rings)
    for (size_t i = 1; i < ring.size(); ++i) {
      const float step_s = ring.time_s[i] - ring.time_s[i - 1];
      if (step_s > 1e-6f) period_s = std::min(period_s, step_s);
    }
  return period_s;
}

void mark_shadow_edges(Ring& ring, float period_s, const FeatureConfig& config) {
  constexpr float kNear = 10.5f;  // steps that still count as beside each other
  const auto jump_m = static_cast<float>(config.occlusion_jump_m);
  for (size_t i = 0; i + 1 < ring.size(); ++i) {
    if (ring.time_s[i + 1] - ring.time_s[i] > kNear * period_s) continue;
    const float step_m = ring.range_m[i + 1] - ring.range_m[i];
    if (step_m > jump_m) {
      const size_t last = std::min(i + static_cast<size_t>(config.occlusion_neighbours), ring.size() - 1);
      for (size_t j = i + 1; j <= last; ++j) ring.shadowed[j] = 1;
    } else if (-step_m > jump_m) {
      const auto n = static_cast<size_t>(config.occlusion_neighbours);
      for (size_t j = i + 1 > n ? i + 1 - n : 0; j <= i; ++j) ring.shadowed[j] = 1;
    }
  }
}

struct Tester {
  const Cloud& points_lidar;
  const FeatureConfig& config;
  float period_s;
  float max_sine;  // of the angle between beam and surface normal's plane, i.e. |cos(beam, tangent)|

  // Straight over `half` neighbours on either side? Distance of the point from the line through the mean of
  // its neighbours along their chord. Unlike the sum of range differences this does not grow with the angle
  // of incidence on a plane.
  bool planar(const Ring& ring, size_t i, int half, Feature& feature) const {
    const auto h = static_cast<size_t>(half);
    if (i < h || i + h >= ring.size()) return false;
    if (ring.time_s[i + h] - ring.time_s[i - h] > (2.0f * static_cast<float>(half) + 3.5f) * period_s)
      return false;
    const Vec3 p = points_lidar[ring.index[i]].cast<double>();
    const Vec3 mean = (ring.prefix_lidar[i + h + 1] - ring.prefix_lidar[i - h] - p) / (2.0 * half);
    const Vec3 chord = (points_lidar[ring.index[i + h]] - points_lidar[ring.index[i - h]]).cast<double>();
    const double length = chord.norm();
    if (length < 1e-4) return false;
    const Vec3 tangent = chord / length;
    const Vec3 off = mean - p;
    const double deviation_m = (off - off.dot(tangent) * tangent).norm();
    if (deviation_m > config.planar_threshold_m) return false;
    if (std::abs(tangent.dot(p)) > max_sine * p.norm()) return false;
    feature = {points_lidar[ring.index[i]], tangent.cast<float>(), 0};
    return true;
  }

  // No range step within `half` neighbours.
  bool smooth(const Ring& ring, size_t i, int half) const {
    const auto h = static_cast<size_t>(half);
    if (i < h || i + h >= ring.size()) return false;
    const auto jump_m = static_cast<float>(config.occlusion_jump_m);
    for (size_t j = i - h; j < i + h; ++j)
      if (std::abs(ring.range_m[j + 1] - ring.range_m[j]) > jump_m) return false;
    return true;
  }
};

}  // namespace

std::vector<Feature> select_planar_features(const LidarScan& scan, const Cloud& points_lidar, int rings,
                                            const FeatureConfig& config) {
  std::vector<Ring> by_ring(static_cast<size_t>(rings));
  for (Ring& ring : by_ring) ring.clear();
  for (uint32_t i = 0; i < scan.points.size(); ++i)
    if (scan.points[i].ring < rings) by_ring[scan.points[i].ring].push(i, scan.points[i], points_lidar[i]);

  const float period_s = firing_period_s(by_ring);
  const auto max_sine = static_cast<float>(std::sin(config.parallel_beam_deg * std::numbers::pi / 180.0));
  const Tester tester{points_lidar, config, period_s, max_sine};
  std::vector<Feature> features;
  features.reserve(scan.points.size());
  for (Ring& ring : by_ring) {
    mark_shadow_edges(ring, period_s, config);
    for (size_t i = 0; i < ring.size(); ++i) {
      if (ring.shadowed[i] || ring.range_m[i] < config.min_range_m) continue;
      Feature feature;
      for (const int half : {config.half_window, config.short_half_window})
        if (tester.smooth(ring, i, half) && tester.planar(ring, i, half, feature)) {
          feature.ring = scan.points[ring.index[i]].ring;
          features.push_back(feature);
          break;
        }
    }
  }
  return features;
}

std::vector<Feature> thin_features(const std::vector<Feature>& features, double voxel_m) {
  const auto inverse = static_cast<float>(1.0 / voxel_m);
  KeyIndex seen(features.size() / 2);
  std::vector<Feature> kept;
  for (const Feature& feature : features) {
    const Eigen::Vector3f& t = feature.tangent_lidar;
    const unsigned tag = std::abs(t.x()) > std::abs(t.y()) ? 1 : 0;
    const size_t before = seen.size();
    seen.insert(voxel_key(feature.point_lidar, inverse, tag));
    if (seen.size() > before) kept.push_back(feature);
  }
  return kept;
}

}  // namespace vsslam

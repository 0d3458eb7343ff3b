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

// The scan sorted by ring, each ring in order of time. Prefix sums make means and counts over a window O(1).
struct RingOrder {
  std::vector<uint32_t> begin;  // of each ring, and the end of the last
  std::vector<uint32_t> index;  // into scan.points
  std::vector<float> range_m, time_s;
  Cloud points_lidar;           // sorted
  std::vector<uint32_t> steps;  // number of range steps before i
  std::vector<uint8_t> shadowed;
  float period_s = std::numeric_limits<float>::max();  // between two firings of a laser: the shortest seen

  RingOrder(const LidarScan& scan, const Cloud& undistorted_lidar, int rings, double jump_m) {
    sort_by_ring(scan, static_cast<size_t>(rings));
    const size_t n = index.size();
    range_m.resize(n);
    time_s.resize(n);
    shadowed.assign(n, 0);
    points_lidar.resize(n);
    for (size_t i = 0; i < n; ++i) {
      const LidarPoint& p = scan.points[index[i]];
      range_m[i] = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
      time_s[i] = p.time_s;
      points_lidar[i] = undistorted_lidar[index[i]];
    }
    count_steps(static_cast<float>(jump_m));
  }

  void sort_by_ring(const LidarScan& scan, size_t rings) {
    begin.assign(rings + 1, 0);
    for (const LidarPoint& p : scan.points)
      if (p.ring < rings) ++begin[p.ring + 1u];
    for (size_t r = 0; r < rings; ++r) begin[r + 1] += begin[r];
    std::vector<uint32_t> next = begin;
    index.resize(begin.back());
    for (uint32_t i = 0; i < scan.points.size(); ++i)
      if (scan.points[i].ring < rings) index[next[scan.points[i].ring]++] = i;
  }

  void count_steps(float jump_m) {
    steps.assign(index.size() + 1, 0);
    for (size_t i = 1; i < index.size(); ++i) {
      steps[i] = steps[i - 1] + (std::abs(range_m[i] - range_m[i - 1]) > jump_m ? 1 : 0);
      const float step_s = time_s[i] - time_s[i - 1];
      if (step_s > 1e-6f) period_s = std::min(period_s, step_s);
    }
  }
};

// Beside a range step the farther surface is seen only up to the shadow of the nearer one.
void mark_shadow_edges(RingOrder& order, size_t begin, size_t end, const FeatureConfig& config) {
  constexpr float kNear = 10.5f;  // firings that still count as beside each other
  const auto n = static_cast<size_t>(config.occlusion_neighbours);
  for (size_t i = begin; i + 1 < end; ++i) {
    if (order.steps[i + 1] == order.steps[i]) continue;
    if (order.time_s[i + 1] - order.time_s[i] > kNear * order.period_s) continue;
    const bool next_is_farther = order.range_m[i + 1] > order.range_m[i];
    const size_t first = next_is_farther ? i + 1 : std::max(begin + n, i + 1) - n;
    const size_t last = next_is_farther ? std::min(i + n, end - 1) : i;
    for (size_t j = first; j <= last; ++j) order.shadowed[j] = 1;
  }
}

struct StraightnessTest {
  const RingOrder& order;
  float max_deviation_m;
  float max_sine;  // |cos(beam, tangent)|, i.e. the sine of the angle of incidence in the ring's direction

  // Straight over `half` neighbours on either side, without range step or gap: all lie near the line through
  // the point along their chord. Unlike the sum of range differences this does not grow with the angle of
  // incidence on a plane.
  bool operator()(size_t i, size_t half, size_t begin, size_t end, Feature& feature) const {
    if (i < begin + half || i + half >= end) return false;
    const size_t first = i - half, last = i + half;
    if (order.steps[last] != order.steps[first]) return false;
    const float longest_s = (2.0f * static_cast<float>(half) + 3.5f) * order.period_s;
    if (order.time_s[last] - order.time_s[first] > longest_s) return false;
    const Eigen::Vector3f p = order.points_lidar[i];
    const Eigen::Vector3f chord = order.points_lidar[last] - order.points_lidar[first];
    const float length2 = chord.squaredNorm();
    if (length2 < 1e-8f) return false;
    const float along_beam = chord.dot(p);
    if (along_beam * along_beam > max_sine * max_sine * length2 * p.squaredNorm()) return false;
    const float limit = max_deviation_m * max_deviation_m * length2;
    for (size_t j = first; j <= last; ++j)
      if ((order.points_lidar[j] - p).cross(chord).squaredNorm() > limit) return false;
    feature.point_lidar = p;
    feature.chord_lidar = chord;
    return true;
  }
};

}  // namespace

namespace {

uint64_t thinning_key(const Eigen::Vector3f& point, const Eigen::Vector3f& chord, float inverse_voxel) {
  return voxel_key(point, inverse_voxel, std::abs(chord.x()) > std::abs(chord.y()) ? 1 : 0);
}

// Which features have been kept, by voxel and direction of the chord.
struct Thinning {
  KeyIndex seen;
  float inverse_voxel;

  Thinning(size_t expected, double voxel_m)
      : seen(expected), inverse_voxel(static_cast<float>(1.0 / voxel_m)) {}

  bool has(const Eigen::Vector3f& point, const Eigen::Vector3f& chord) const {
    return seen.find(thinning_key(point, chord, inverse_voxel)) >= 0;
  }
  bool add(const Feature& feature) {
    const size_t before = seen.size();
    seen.insert(thinning_key(feature.point_lidar, feature.chord_lidar, inverse_voxel));
    return seen.size() > before;
  }
};

// Calls keep(feature) for each planar point; skips a point unseen if skip(i, begin, end) says so.
template <class Skip, class Keep>
void for_each_planar(RingOrder& order, const FeatureConfig& config, const Skip& skip, const Keep& keep) {
  const StraightnessTest straight{
      order, static_cast<float>(config.planar_threshold_m),
      static_cast<float>(std::sin(config.parallel_beam_deg * std::numbers::pi / 180))};
  const auto half = static_cast<size_t>(config.half_window);
  const auto short_half = static_cast<size_t>(config.short_half_window);
  for (size_t ring = 0; ring + 1 < order.begin.size(); ++ring) {
    const size_t begin = order.begin[ring], end = order.begin[ring + 1];
    mark_shadow_edges(order, begin, end, config);
    Feature feature;
    feature.ring = static_cast<uint16_t>(ring);
    for (size_t i = begin; i < end; ++i) {
      if (order.shadowed[i] || order.range_m[i] < config.min_range_m || skip(i, begin, end)) continue;
      if (straight(i, half, begin, end, feature) || straight(i, short_half, begin, end, feature))
        keep(feature);
    }
  }
}

}  // namespace

std::vector<Feature> select_planar_features(const LidarScan& scan, const Cloud& points_lidar, int rings,
                                            const FeatureConfig& config) {
  RingOrder order(scan, points_lidar, rings, config.occlusion_jump_m);
  std::vector<Feature> features;
  features.reserve(order.index.size());
  for_each_planar(
      order, config, [](size_t, size_t, size_t) { return false; },
      [&](const Feature& feature) { features.push_back(feature); });
  return features;
}

std::vector<Feature> select_thin_features(const LidarScan& scan, const Cloud& points_lidar, int rings,
                                          const FeatureConfig& config, double voxel_m) {
  RingOrder order(scan, points_lidar, rings, config.occlusion_jump_m);
  Thinning thinning(order.index.size() / 8, voxel_m);
  std::vector<Feature> kept;
  // The test of straightness is the dear part. Whatever it says, a point is dropped if its voxel has a
  // feature of either direction that the point could have.
  const auto taken = [&](size_t i, size_t half, size_t begin, size_t end) {
    if (i < begin + half || i + half >= end) return true;  // cannot be straight over this window
    const Eigen::Vector3f chord = order.points_lidar[i + half] - order.points_lidar[i - half];
    return thinning.has(order.points_lidar[i], chord);
  };
  const auto half = static_cast<size_t>(config.half_window);
  const auto short_half = static_cast<size_t>(config.short_half_window);
  for_each_planar(
      order, config,
      [&](size_t i, size_t begin, size_t end) {
        return taken(i, half, begin, end) && taken(i, short_half, begin, end);
      },
      [&](const Feature& feature) {
        if (thinning.add(feature)) kept.push_back(feature);
      });
  return kept;
}

std::vector<Feature> thin_features(const std::vector<Feature>& features, double voxel_m) {
  Thinning thinning(features.size() / 2, voxel_m);
  std::vector<Feature> kept;
  for (const Feature& feature : features)
    if (thinning.add(feature)) kept.push_back(feature);
  return kept;
}

}  // namespace vsslam

#include "slam/lidar/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "slam/lidar/scattered_order.h"
#include "slam/lidar/voxel_hash.h"

namespace vsslam {

void FeatureConfig::fields(Fields& f) {
  f("half_window", half_window, between(1, 50));
  f("short_half_window", short_half_window, between(1, 50));
  f.automatic("planar_threshold_m", planar_threshold_m, positive());
  f("occlusion_jump_m", occlusion_jump_m, positive());
  f("occlusion_neighbours", occlusion_neighbours, between(0, 50));
  f("parallel_beam_deg", parallel_beam_deg, between(0, 90));
  f("min_range_m", min_range_m, non_negative());
  f.check(short_half_window <= half_window, "short_half_window", "at most half_window");
}

namespace {

// Beside a range step the farther surface is seen only up to the shadow of the nearer one.
void mark_shadow_edges(RingOrder& order, size_t begin, size_t end, const FeatureConfig& config) {
  constexpr float kNear = 10.5f;  // firings that still count as beside each other
  const auto n = static_cast<size_t>(config.occlusion_neighbours);
  for (size_t i = begin; i + 1 < end; ++i) {
    if (order.steps[i + 1] == order.steps[i]) continue;
    if (order.firing[i + 1] - order.firing[i] > kNear) continue;
    const bool next_is_farther = order.range_m[i + 1] > order.range_m[i];
    const size_t first = next_is_farther ? i + 1 : std::max(begin + n, i + 1) - n;
    const size_t last = next_is_farther ? std::min(i + n, end - 1) : i;
    for (size_t j = first; j <= last; ++j) order.shadowed[j] = 1;
  }
}

// Half the windows of a point, in firings.
struct Windows {
  const RingOrder& order;
  size_t half, short_half;
  float least_chord_m;

  Windows(const RingOrder& ring_order, double range_sigma_m, const FeatureConfig& config)
      : order(ring_order),
        half(static_cast<size_t>(config.half_window)),
        short_half(static_cast<size_t>(config.short_half_window)),
        least_chord_m(static_cast<float>(5 * range_sigma_m)) {}

  // Its direction is known to about sqrt(2) / 5 rad, enough to tell a jamb from its wall.
  std::pair<size_t, size_t> at(size_t i) const {
    constexpr size_t kMost = 25;  // of 2000 a turn: 9 degrees
    const float spacing_m = order.range_m[i] * order.step_rad;
    if (2 * spacing_m * static_cast<float>(half) >= least_chord_m || spacing_m <= 0) return {half, short_half};
    const auto needed = std::min(kMost, static_cast<size_t>(0.5f * least_chord_m / spacing_m) + 1);
    return {std::max(half, needed), std::max(short_half, needed * short_half / half)};
  }
};

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
    const float longest = 2.0f * static_cast<float>(half) + 3.5f;  // firings
    if (order.firing[last] - order.firing[first] > longest) return false;
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

// Cells of about `voxel_m` seen from the sensor: equal angles on the faces of a cube about it, for ranges of one octave of
// the range's square. Noise moves a point along its beam and so not to another cell. (Cubes of space are no good: of a
// wall that lies along their border they keep as many of the few points that noise puts beyond as of the many before, and
// the wall comes out shifted, by another amount where it crosses the next border: the scan comes out turned.)
uint64_t thinning_key(const Eigen::Vector3f& point, const Eigen::Vector3f& chord, float inverse_voxel) {
  int axis = 0;
  point.cwiseAbs().maxCoeff(&axis);
  const float depth = point[axis], inverse_depth = 1 / depth;
  int octave = 0;  // of the squared range
  const float mantissa = std::frexp(point.squaredNorm(), &octave);
  if (!(mantissa > 0)) return 0;
  const float range_m = std::sqrt(std::ldexp(0.75f, octave));
  const float cells = range_m * inverse_voxel;  // to a radian
  const auto cell = [&](float tangent) {
    constexpr float kLinear = 1.2732f, kSquare = 0.2732f;  // 4 / pi atan(t) = t (kLinear - kSquare |t|) to half a percent
    constexpr float kAngle = 0.7854f;
    const float angle_rad = kAngle * tangent * (kLinear - kSquare * std::abs(tangent));
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(angle_rad * cells))) & 0xFFFFFu;
  };
  const uint64_t face = static_cast<uint64_t>(axis) * 2 + (depth > 0 ? 1 : 0);
  const uint64_t direction = std::abs(chord.x()) > std::abs(chord.y()) ? 1 : 0;
  return cell(point[(axis + 1) % 3] * inverse_depth) | cell(point[(axis + 2) % 3] * inverse_depth) << 20 |
         static_cast<uint64_t>(octave + 512) << 40 | (face << 1 | direction) << 60;
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

// Calls keep(feature) for each planar point; skips a point unseen if skip(i, half, short_half, begin, end) says so.
template <class Skip, class Keep>
void for_each_planar(RingOrder& order, double range_sigma_m, const FeatureConfig& config, const Skip& skip,
                     const Keep& keep) {
  constexpr double kPlanarSigmas = 4.3;
  const StraightnessTest straight{
      order, static_cast<float>(config.planar_threshold_m.value_or(kPlanarSigmas * range_sigma_m)),
      static_cast<float>(std::sin(config.parallel_beam_deg * std::numbers::pi / 180))};
  const Windows windows(order, range_sigma_m, config);
  for (size_t ring = 0; ring < order.rings(); ++ring)
    mark_shadow_edges(order, order.begin[ring], order.begin[ring + 1], config);
  const size_t n = order.index.size();
  ScatteredOrder places(n);
  Feature feature;
  for (size_t k = 0; k < n; ++k) {
    const size_t i = places.next();
    if (order.shadowed[i] || order.range_m[i] < config.min_range_m) continue;
    feature.ring = order.ring[i];
    const size_t begin = order.begin[feature.ring], end = order.begin[feature.ring + 1u];
    const auto [half, short_half] = windows.at(i);
    if (skip(i, half, short_half, begin, end)) continue;
    if (straight(i, half, begin, end, feature) || straight(i, short_half, begin, end, feature)) keep(feature);
  }
}

}  // namespace

std::vector<Feature> select_planar_features(const LidarScan& scan, const Cloud& points_lidar,
                                            double range_sigma_m, const FeatureConfig& config) {
  RingOrder order(scan, points_lidar, range_step_m(range_sigma_m, config));
  std::vector<Feature> features;
  features.reserve(order.index.size());
  for_each_planar(
      order, range_sigma_m, config, [](size_t, size_t, size_t, size_t, size_t) { return false; },
      [&](const Feature& feature) { features.push_back(feature); });
  return features;
}

std::vector<Feature> select_thin_features(RingOrder& order, double range_sigma_m, const FeatureConfig& config,
                                          double voxel_m) {
  Thinning thinning(order.index.size() / 8, voxel_m);
  std::vector<Feature> kept;
  // The test of straightness is the dear part. Whatever it says, a point is dropped if its voxel has a
  // feature of either direction that the point could have.
  const auto taken = [&](size_t i, size_t half, size_t begin, size_t end) {
    if (i < begin + half || i + half >= end) return true;  // cannot be straight over this window
    const Eigen::Vector3f chord = order.points_lidar[i + half] - order.points_lidar[i - half];
    return thinning.has(order.points_lidar[i], chord);
  };
  for_each_planar(
      order, range_sigma_m, config,
      [&](size_t i, size_t half, size_t short_half, size_t begin, size_t end) {
        return taken(i, half, begin, end) && taken(i, short_half, begin, end);
      },
      [&](const Feature& feature) {
        if (thinning.add(feature)) kept.push_back(feature);
      });
  return kept;
}

double range_step_m(double range_sigma_m, const FeatureConfig& config) {
  constexpr double kNoiseSigmas = 6;  // of the difference of two ranges 4.2: no step on a smooth surface
  return std::max(config.occlusion_jump_m, kNoiseSigmas * range_sigma_m);
}

std::vector<Feature> thin_features(const std::vector<Feature>& features, double voxel_m) {
  Thinning thinning(features.size() / 2, voxel_m);
  std::vector<Feature> kept;
  for (const Feature& feature : features)
    if (thinning.add(feature)) kept.push_back(feature);
  return kept;
}

}  // namespace vsslam

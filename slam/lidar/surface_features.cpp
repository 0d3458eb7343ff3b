#include "slam/lidar/surface_features.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <numbers>
#include <optional>

#include "slam/lidar/patch.h"
#include "slam/lidar/scattered_order.h"
#include "slam/lidar/voxel_hash.h"

namespace vsslam {

namespace {

constexpr size_t kNeighbours = 12;   // a plane needs 3; a dozen give its thickness to 20 %
constexpr size_t kLeastNeighbours = 6;
constexpr double kRadiusShare = 0.05;  // of the range: two lines of a scanner with 32 lasers over 40 degrees
constexpr double kLineShare = 0.02;    // spread of the shorter side, as share of the longer: less is a line

// One point per cube: dense lines of a scanner would be each other's only neighbours.
Cloud thinned(const Cloud& points, double voxel_m, double min_range_m) {
  const auto inverse = static_cast<float>(1 / voxel_m);
  const auto least2 = static_cast<float>(min_range_m * min_range_m);
  KeyIndex seen(points.size() / 4);
  Cloud kept;
  ScatteredOrder places(points.size());
  for (size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3f& p = points[places.next()];
    if (p.squaredNorm() < least2) continue;
    if (static_cast<size_t>(seen.insert(voxel_key(p, inverse))) == kept.size()) kept.push_back(p);
  }
  return kept;
}

class Neighbourhood {
 public:
  explicit Neighbourhood(const Cloud& points) : points_(points), tree_(3, *this, {16}) {}

  std::optional<Patch> about(const Eigen::Vector3f& point, double least_radius_m) const {
    uint32_t index[kNeighbours];
    float distance2[kNeighbours];
    const size_t found = tree_.knnSearch(point.data(), kNeighbours, index, distance2);
    const double radius_m = std::max(least_radius_m, kRadiusShare * static_cast<double>(point.norm()));
    Vec3 mean = Vec3::Zero();
    Mat3 square = Mat3::Zero();
    double count = 0;
    for (size_t i = 0; i < found && distance2[i] <= radius_m * radius_m; ++i, ++count) {
      const Vec3 offset = (points_[index[i]] - point).cast<double>();
      mean += offset;
      square += offset * offset.transpose();
    }
    if (count < kLeastNeighbours) return std::nullopt;
    return Patch(mean / count, square / count, count);
  }

  // For nanoflann.
  size_t kdtree_get_point_count() const { return points_.size(); }
  float kdtree_get_pt(size_t i, size_t k) const { return points_[i][static_cast<Eigen::Index>(k)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }

 private:
  using Metric = nanoflann::L2_Simple_Adaptor<float, Neighbourhood>;
  const Cloud& points_;
  nanoflann::KDTreeSingleIndexAdaptor<Metric, Neighbourhood, 3, uint32_t> tree_;
};

bool planar(const Patch& patch) {
  constexpr double kFlat = 0.1;  // thickness against the shorter side (variances), as GenZ-ICP's planarity
  return patch.spread_m2[1] > kLineShare * patch.spread_m2[2] && patch.spread_m2[0] < kFlat * patch.spread_m2[1];
}

Eigen::Vector3f tangent(const Vec3& normal, const Eigen::Vector3f& point) {
  Vec3 along = normal.cross(Vec3::UnitZ());
  if (along.norm() < 0.3) along = Vec3::UnitZ().cross(point.cast<double>());  // ground: as a ring runs on it
  along -= normal * normal.dot(along);
  return along.normalized().cast<float>();
}

}  // namespace

std::vector<Feature> select_surface_features(const Cloud& points_lidar, double range_sigma_m, double voxel_m,
                                             const FeatureConfig& config) {
  // The map takes a chord that leaves its plane by more than 5.7 times the noise for another surface: of a tangent
  // 16 times as long, normals that differ by 20 degrees.
  const auto chord_m = static_cast<float>(16 * range_sigma_m);
  const double max_thickness_m = 3 * range_sigma_m + 0.02;  // and what is rough
  const Cloud dense = thinned(points_lidar, 0.5 * voxel_m, config.min_range_m);
  const Neighbourhood neighbourhood(dense);
  std::vector<Feature> features;
  for (const Eigen::Vector3f& point : thinned(dense, voxel_m, config.min_range_m)) {
    const std::optional<Patch> patch = neighbourhood.about(point, 3 * voxel_m);
    if (!patch || !planar(*patch) || patch->spread_m2[0] > max_thickness_m * max_thickness_m) continue;
    const float elevation_deg = std::atan2(point.z(), point.head<2>().norm()) * 180 / std::numbers::pi_v<float>;
    features.push_back(
        {point, chord_m * tangent(patch->normal, point), static_cast<uint16_t>(elevation_deg + 90)});
  }
  return features;
}

double measured_surface_sigma_m(const Cloud& points_lidar, double voxel_m, const FeatureConfig& config) {
  constexpr size_t kLeast = 100, kSampled = 2000;
  const Cloud dense = thinned(points_lidar, 0.5 * voxel_m, config.min_range_m);
  const Neighbourhood neighbourhood(dense);
  std::vector<double> sigmas_m;
  const size_t stride = std::max<size_t>(1, dense.size() / kSampled);
  for (size_t i = 0; i < dense.size(); i += stride) {
    const std::optional<Patch> patch = neighbourhood.about(dense[i], 3 * voxel_m);
    if (!patch || !planar(*patch)) continue;
    const double unbiased = patch->count / (patch->count - 3);  // a plane was fitted
    sigmas_m.push_back(std::sqrt(patch->spread_m2[0] * unbiased));
  }
  if (sigmas_m.size() < kLeast) return 0;
  const auto middle = sigmas_m.begin() + static_cast<std::ptrdiff_t>(sigmas_m.size() / 2);
  std::nth_element(sigmas_m.begin(), middle, sigmas_m.end());
  return *middle;
}

}  // namespace vsslam

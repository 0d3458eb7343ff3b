#include "slam/lidar/lidar_odometry.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace vsslam {

void LidarOdometryConfig::fields(Fields& f) {
  f.automatic("range_sigma_m", range_sigma_m, between(1e-4, 1));
  f("features", features);
  f.automatic("voxel_m", voxel_m, positive());
  f.automatic("map_voxel_m", map_voxel_m, positive());
  f("local_map_keys", local_map_keys, between(1, 10000));
  f("key_distance_m", key_distance_m, positive());
  f("key_angle_rad", key_angle_rad, positive());
  f("map", map);
  f("registration", registration);
  f("search", search);
  f("degeneracy", degeneracy);
}

// The median over the first scans: a scan's own figure is good to a percent where it sees walls, but leaves and grass
// look like noise, and the first scan may see little else.
void LidarOdometry::listen(double scan_sigma_m) {
  constexpr double kLeast_m = 0.003;  // ranges are given in steps of 2-4 mm, and no scanner is better
  if (!listens() || scan_sigma_m <= 0) return;
  heard_m_.push_back(scan_sigma_m);
  std::vector<double> sorted = heard_m_;
  std::sort(sorted.begin(), sorted.end());
  range_sigma_m_ = std::max(kLeast_m, sorted[sorted.size() / 2]);
}

// Of N points with the noise of a VLP-16, 7 mm, half a thousand know each of six directions to a millimetre. Beyond some
// thousands more points know no more than the planes that they share.
bool LidarOdometry::fit_voxel(int matches) {
  constexpr int kFew = 500, kMany = 3000;
  constexpr double kFinest_m = 0.05, kCoarsest_m = 0.4;
  if (config_.voxel_m) return false;
  const double before_m = voxel_m_;
  if (matches < kFew) voxel_m_ = std::max(kFinest_m, 0.5 * voxel_m_);
  if (matches > kMany) voxel_m_ = std::min(kCoarsest_m, 2 * voxel_m_);
  return voxel_m_ != before_m;
}

int LidarOdometry::matches(const std::vector<Feature>& thin_features, const SE3& T_odom_lidar) const {
  return count_matches(thin_features, T_odom_lidar, map_, range_sigma_m(), config_.registration);
}

namespace {

double median_range_m(const std::vector<Feature>& features) {
  if (features.empty()) return 1;
  std::vector<float> ranges;
  for (const Feature& feature : features) ranges.push_back(feature.point_lidar.norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return std::max(1.0, static_cast<double>(*middle));
}

// Wide enough to find again a robot that went astray for some scans.
PosePrior astray(PosePrior prior) {
  constexpr double kPosition_m = 0.5, kYaw_rad = 0.1;
  prior.covariance.diagonal().head<3>().array() += kYaw_rad * kYaw_rad;
  prior.covariance.diagonal().tail<3>().array() += kPosition_m * kPosition_m;
  return prior;
}

}  // namespace

// What is seen for the first time, around a corner, has no planes yet; what is seen again must fit as it did.
bool LidarOdometry::looks_lost(const Registration& registration) const {
  constexpr double kLost = 0.2, kSeenAgain = 0.1;  // of the features
  return registration.used_prior_only || registration.misfit > usual_misfit_ + kLost ||
         registration.cost > 1 - kSeenAgain * (1 - usual_misfit_);
}

Registration LidarOdometry::align(const std::vector<Feature>& thin_features, const PosePrior& prior) {
  constexpr double kMemory = 0.9;
  constexpr double kFewer = 0.1;  // of the features, that are not where they were lately: reason to look at once
  constexpr int kLongestPause = 32;
  const auto from = [&](const SE3& start, const PosePrior& around) {
    return register_scan(thin_features, around, start, map_, noise(), config_.registration, config_.degeneracy);
  };
  ++scans_since_key_;
  Registration best = from(prior.T_odom_lidar, prior);
  const double range_m = median_range_m(thin_features);
  const bool lost = looks_lost(best);
  const bool enough = thin_features.size() >= static_cast<size_t>(config_.registration.min_correspondences);
  const bool fewer = best.cost > usual_cost_ + kFewer;
  const bool could_miss = lost || needs_search(prior, range_m, config_.search);
  if (enough && could_miss && (--search_waits_ < 0 || fewer)) {
    const PosePrior around = lost ? astray(prior) : prior;
    const double standing_cost = best.cost;
    for (const SE3& start : likely_poses(thin_features, around, range_m, map_, range_sigma_m(), config_.search)) {
      const Registration other = from(start, around);
      if (!other.used_prior_only && other.cost < best.cost &&
          other.cost < standing_cost - config_.search.clearly_better)
        best = other;
    }
    search_pause_ = best.cost < standing_cost ? 0 : std::clamp(2 * search_pause_, 1, kLongestPause);
    search_waits_ = search_pause_;
  }
  if (!best.used_prior_only) {
    const bool first = usual_misfit_ == 1;
    usual_misfit_ = first ? best.misfit : kMemory * usual_misfit_ + (1 - kMemory) * best.misfit;
    usual_cost_ = first ? best.cost : kMemory * usual_cost_ + (1 - kMemory) * best.cost;
  }
  return best;
}

Mat6 LidarOdometry::step_covariance(const std::vector<Feature>& thin_features, const SE3& T_odom_lidar) const {
  constexpr double kUnseen = 1;  // 1 m, 1 rad: what no surface sees
  const double new_share = 1.0 / config_.local_map_keys;  // from key scan to key scan one in the map is another
  const Mat6 information =
      step_information(thin_features, T_odom_lidar, map_, range_sigma_m(), new_share, config_.registration);
  return (information + kUnseen * Mat6::Identity()).ldlt().solve(Mat6::Identity());
}

bool LidarOdometry::wants_key(const SE3& T_odom_base) const {
  if (!T_odom_lastkey_) return true;
  const SE3 T_lastkey_base = T_odom_lastkey_->inverse() * T_odom_base;
  return T_lastkey_base.translation.norm() >= config_.key_distance_m ||
         T_lastkey_base.angle() >= config_.key_angle_rad;
}

void LidarOdometry::insert_key(const std::vector<Feature>& features, const SE3& T_odom_base,
                               const SE3& T_base_lidar) {
  // No prior remembers longer than some seconds what a plane told.
  constexpr double kMemory = 0.8, kMostScans = 30;
  if (keys_made_ > 0)
    scans_per_key_ = kMemory * scans_per_key_ + (1 - kMemory) * std::min<double>(kMostScans, scans_since_key_);
  scans_since_key_ = 0;
  T_odom_lastkey_ = T_odom_base;
  const SE3 T_odom_lidar = T_odom_base * T_base_lidar;
  const Eigen::Matrix3f R = T_odom_lidar.matrix3().cast<float>();
  const Eigen::Vector3f t = T_odom_lidar.translation.cast<float>();
  constexpr uint32_t kRings = 37;  // lines of different key scans rarely share a bit
  std::vector<MapPoint> points_odom;
  points_odom.reserve(features.size());
  for (const Feature& feature : features)
    points_odom.push_back(
        {R * feature.point_lidar + t, R * feature.chord_lidar, kRings * keys_made_ + feature.ring});
  ++keys_made_;
  keys_odom_.push_back(std::move(points_odom));
  if (keys_odom_.size() > static_cast<size_t>(config_.local_map_keys)) keys_odom_.pop_front();
  map_.rebuild(keys_odom_, range_sigma_m());
}

void LidarOdometry::replace_first_key(const std::vector<Feature>& features, const SE3& T_odom_base,
                                      const SE3& T_base_lidar) {
  keys_odom_.clear();
  keys_made_ = 0;
  insert_key(features, T_odom_base, T_base_lidar);
}

}  // namespace vsslam

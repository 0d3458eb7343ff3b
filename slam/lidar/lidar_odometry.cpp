#include "slam/lidar/lidar_odometry.h"

namespace vsslam {

void LidarOdometryConfig::fields(Fields& f) {
  f("features", features);
  f("voxel_m", voxel_m, positive());
  f("map_voxel_m", map_voxel_m, positive());
  f("local_map_keys", local_map_keys, between(1, 10000));
  f("key_distance_m", key_distance_m, positive());
  f("key_angle_rad", key_angle_rad, positive());
  f("map", map);
  f("registration", registration);
  f("degeneracy", degeneracy);
}

Registration LidarOdometry::align(const std::vector<Feature>& thin_features,
                                  const SE3& T_odom_lidar_prior) const {
  return register_scan(thin_features, T_odom_lidar_prior, map_, config_.registration, config_.degeneracy);
}

bool LidarOdometry::wants_key(const SE3& T_odom_base) const {
  if (!T_odom_lastkey_) return true;
  const SE3 T_lastkey_base = T_odom_lastkey_->inverse() * T_odom_base;
  return T_lastkey_base.translation.norm() >= config_.key_distance_m ||
         T_lastkey_base.angle() >= config_.key_angle_rad;
}

void LidarOdometry::insert_key(const std::vector<Feature>& features, const SE3& T_odom_base,
                               const SE3& T_base_lidar) {
  T_odom_lastkey_ = T_odom_base;
  const SE3 T_odom_lidar = T_odom_base * T_base_lidar;
  const Eigen::Matrix3f R = T_odom_lidar.matrix3().cast<float>();
  const Eigen::Vector3f t = T_odom_lidar.translation.cast<float>();
  constexpr uint32_t kRings = 37;  // lines of different key scans rarely share a bit
  std::vector<MapPoint> points_odom;
  for (const Feature& feature : thin_features(features, config_.map_voxel_m))
    points_odom.push_back(
        {R * feature.point_lidar + t, R * feature.chord_lidar, kRings * keys_made_ + feature.ring});
  ++keys_made_;
  keys_odom_.push_back(std::move(points_odom));
  if (keys_odom_.size() > static_cast<size_t>(config_.local_map_keys)) keys_odom_.pop_front();
  map_.rebuild(keys_odom_);
}

}  // namespace vsslam

// LiDAR odometry against a local map of recent key scans. Lives in the odom frame: loop closures do not touch
// it.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/calibration.h"
#include "core/config.h"
#include "slam/lidar/features.h"
#include "slam/lidar/plane_map.h"
#include "slam/lidar/registration.h"

namespace vsslam {

/// Defaults are for indoors; outdoors voxel_m 0.4.
struct LidarOdometryConfig {
  FeatureConfig features;
  double voxel_m = 0.2;         ///< thinning of the features that are registered and kept with key scans
  double map_voxel_m = 0.1;     ///< thinning of the features that enter the local map
  int local_map_keys = 25;      ///< key scans in the local map
  double key_distance_m = 1.0;  ///< a key scan after this far ...
  double key_angle_rad = 0.2;   ///< ... or this much rotation
  PlaneMapConfig map;
  RegistrationConfig registration;
  DegeneracyConfig degeneracy;
  void fields(Fields& f);
};

class LidarOdometry {
 public:
  explicit LidarOdometry(const LidarOdometryConfig& config) : config_(config), map_(config.map) {}

  Registration align(const std::vector<Feature>& thin_features, const SE3& T_odom_lidar_prior) const;
  /// Far enough from the last key scan, or the first.
  bool wants_key(const SE3& T_odom_base) const;
  /// Adds a key scan to the local map; the oldest leaves.
  void insert_key(const std::vector<Feature>& features, const SE3& T_odom_base, const SE3& T_base_lidar);

 private:
  LidarOdometryConfig config_;
  PlaneMap map_;
  std::deque<std::vector<MapPoint>> keys_odom_;  // in the map
  std::optional<SE3> T_odom_lastkey_;
  uint32_t keys_made_ = 0;
};

}  // namespace vsslam

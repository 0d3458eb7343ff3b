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
#include "slam/lidar/pose_search.h"
#include "slam/lidar/registration.h"

namespace vsslam {

struct LidarOdometryConfig {
  /// Noise of ranges. Automatic: as the first scans show it, else as the sheet says. Every threshold that is `automatic`
  /// follows from it.
  std::optional<double> range_sigma_m;
  FeatureConfig features;
  /// Thinning of the features that are registered and kept with key scans. Automatic: 0.2 m, and finer or coarser where a
  /// scan would leave few or many.
  std::optional<double> voxel_m;
  std::optional<double> map_voxel_m;  ///< thinning of the features that enter the local map; automatic: half of voxel_m
  int local_map_keys = 25;      ///< key scans in the local map
  double key_distance_m = 1.0;  ///< a key scan after this far ...
  double key_angle_rad = 0.2;   ///< ... or this much rotation
  PlaneMapConfig map;
  RegistrationConfig registration;
  PoseSearchConfig search;
  DegeneracyConfig degeneracy;
  void fields(Fields& f);
};

class LidarOdometry {
 public:
  LidarOdometry(const LidarOdometryConfig& config, double sheet_range_sigma_m)
      : config_(config), map_(config.map), range_sigma_m_(sheet_range_sigma_m) {}

  /// How the ranges of the sensor scatter: what the last scans show, or what was set.
  double range_sigma_m() const { return config_.range_sigma_m.value_or(range_sigma_m_); }
  /// Whether another scan could still tell how noisy the sensor is.
  bool listens() const { return heard_m_.size() < kScansHeard && !config_.range_sigma_m; }
  /// Learns from a scan how noisy the sensor is.
  void listen(double scan_sigma_m);

  double voxel_m() const { return config_.voxel_m.value_or(voxel_m_); }
  double map_voxel_m() const { return config_.map_voxel_m.value_or(0.5 * voxel_m()); }
  /// After a scan of which so many features lie on planes. Whether scans are thinned otherwise from now on.
  bool fit_voxel(int matches);
  /// Of features with planes of the map.
  int matches(const std::vector<Feature>& thin_features, const SE3& T_odom_lidar) const;

  /// Near the prior; where the prior may miss, or the scan fits much worse there than scans did lately, farther around
  /// it too.
  Registration align(const std::vector<Feature>& thin_features, const PosePrior& prior);
  bool has_map() const { return map_.plane_count() > 0; }
  /// Covariance of a registered scan beside another that met the same map.
  Mat6 step_covariance(const std::vector<Feature>& thin_features, const SE3& T_odom_lidar) const;
  /// Whether a scan fits so much worse than scans did lately that it may be lost.
  bool looks_lost(const Registration& registration) const;
  /// Far enough from the last key scan, or the first.
  bool wants_key(const SE3& T_odom_base) const;
  /// Adds a key scan to the local map; the oldest leaves.
  void insert_key(const std::vector<Feature>& features, const SE3& T_odom_base, const SE3& T_base_lidar);
  /// Puts better features in the place of the only key scan.
  void replace_first_key(const std::vector<Feature>& features, const SE3& T_odom_base, const SE3& T_base_lidar);

 private:
  static constexpr size_t kScansHeard = 10;
  ScanNoise noise() const { return {range_sigma_m(), scans_per_key_}; }

  LidarOdometryConfig config_;
  PlaneMap map_;
  std::deque<std::vector<MapPoint>> keys_odom_;  // in the map
  double range_sigma_m_;
  double voxel_m_ = 0.2;
  std::vector<double> heard_m_;  // noise of the first scans
  double usual_misfit_ = 1, usual_cost_ = 1;  // of the scans so far, running means; 1: none yet
  int search_pause_ = 0, search_waits_ = 0;  // scans: after a search that found nothing the next waits twice as long
  std::optional<SE3> T_odom_lastkey_;
  uint32_t keys_made_ = 0;
  int scans_since_key_ = 0;
  double scans_per_key_ = 1;  // lately
};

}  // namespace vsslam

// The front end: samples in, for every scan its pose in the odom frame out. It does not know of loops, so one
// odometry serves any number of methods that map what it finds.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/calibration.h"
#include "core/samples.h"
#include "core/stage_clock.h"
#include "slam/lidar/cloud.h"
#include "slam/odometry_health.h"
#include "slam/scan_report.h"
#include "slam/slam_config.h"

namespace vsslam {

/// A registered scan; with clouds (lidar frame at its stamp) if it is a key scan.
struct OdometryScan {
  ScanReport report;                   ///< key and T_map_base are the mapping's to fill
  Time end;                            ///< of the scan
  std::optional<VisualReport> visual;  ///< of the prior `vio`
  bool is_key = false;
  /// Of a key scan's pose in the frame of the last one's, right perturbation [rotation; translation].
  Mat6 covariance_since_key = Mat6::Identity();
  SharedCloud features_lidar;    ///< planar points, thinned by `odometry.voxel_m`
  SharedCloud points_lidar;      ///< all undistorted points
  SharedCloud map_points_lidar;  ///< of these, one per half of `odometry.voxel_m`
};

class Odometry {
 public:
  Odometry(const SlamConfig& config, const RigCalibration& rig, StageClock* clock = nullptr);
  ~Odometry();

  void add(const ImuSample& sample);
  void add(const WheelSample& sample);
  void add(const CameraFrame& image);
  /// Samples of the other sensors up to scan.end should have been added before.
  OdometryScan add(const LidarScan& scan);
  /// So far.
  OdometryHealth health() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

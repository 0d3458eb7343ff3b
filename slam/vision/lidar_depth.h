// Depth of visual features from recent LiDAR scans (Shan et al., ICRA 2021, section III-B).
#pragma once

#include <memory>

#include "core/calibration.h"
#include "core/config.h"
#include "slam/lidar/cloud.h"
#include "slam/vision/visual_frame.h"

namespace vsslam {

struct LidarDepthConfig {
  double max_age_s = 5.0;  ///< scans older than this are forgotten
  void fields(Fields& f);
};

class LidarDepth {
 public:
  LidarDepth(const LidarDepthConfig& config, const RigCalibration& rig);
  ~LidarDepth();

  /// An undistorted scan at its registered pose.
  void add(Time stamp, const Cloud& points_lidar, const SE3& T_odom_base);
  /// Fills depth_m of the features that the stacked points support, for a camera at T_odom_camera.
  void fill(VisualFrame& frame, const SE3& T_odom_camera) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

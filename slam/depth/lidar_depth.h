// Depth of visual features from recent LiDAR scans (Shan et al., ICRA 2021, section III-B).
#pragma once

#include <memory>

#include "core/calibration.h"
#include "core/config.h"
#include "slam/depth/depth_view.h"
#include "slam/lidar/cloud.h"
#include "slam/vision/visual_frame.h"

namespace vsslam {

struct LidarDepthConfig {
  double max_age_s = 5.0;  ///< scans older than this are forgotten
  double max_range_m = 50.0;
  double key_distance_m = 0.2;  ///< of all scans but the newest, those are kept between which the camera has
  double key_angle_deg = 3.0;   ///< moved or turned so far: from the same place they would look alike
  int max_points = 120000;      ///< in all scans kept; beyond it the oldest are forgotten
  DepthViewConfig view;
  void fields(Fields& f);
};

/// Not thread-safe. Its memory does not grow with time.
class LidarDepth {
 public:
  LidarDepth(const LidarDepthConfig& config, const RigCalibration& rig);
  ~LidarDepth();

  /// An undistorted scan at its registered pose. Scans in order of time.
  void add(Time stamp, const Cloud& points_lidar, const SE3& T_odom_base);
  /// Sets depth_m of each feature: that of the surface which the stacked points support along its ray, for a
  /// camera at T_odom_camera; 0 where they support none.
  void fill(VisualFrame& frame, const SE3& T_odom_camera) const;
  size_t points() const;  ///< held in the stack

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

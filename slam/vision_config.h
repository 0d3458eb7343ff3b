// Settings of the visual side.
#pragma once

#include "core/config.h"
#include "slam/depth/lidar_depth.h"
#include "slam/vio/vio.h"
#include "slam/vision/feature_tracker.h"

namespace vsslam {

struct VisionConfig {
  FeatureTrackerConfig tracker;
  LidarDepthConfig depth;
  VioConfig vio;
  bool lidar_depth = true;  ///< features get their depth from recent scans
  bool lidar_aid = true;    ///< a restart begins at the LiDAR odometry's pose, velocity and bias
  void fields(Fields& f);
};

}  // namespace vsslam

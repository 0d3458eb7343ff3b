// A scan that the back end keeps.
#pragma once

#include "core/se3.h"
#include "core/time.h"
#include "slam/lidar/cloud.h"
#include "slam/lidar/information.h"

namespace vsslam {

struct KeyScan {
  int id = 0;             ///< index in the list of key scans
  int64_t scan = 0;       ///< index of the scan
  Time stamp;
  SE3 T_odom_base;        ///< odometry when it was made; never changes
  SE3 T_map_base;         ///< after the last optimisation
  Cloud features_lidar;   ///< undistorted planar points, thinned by the map's voxel size; lidar frame at `stamp`
  Cloud points_lidar;     ///< undistorted points of the whole scan, for the descriptor; may be released after use
  Information information;
};

}  // namespace vsslam

// A scan that the back end keeps.
#pragma once

#include "core/se3.h"
#include "core/time.h"
#include "slam/lidar/cloud.h"
#include "slam/lidar/information.h"

namespace vsslam {

struct KeyScan {
  int id = 0;        ///< index in the list of key scans
  int64_t scan = 0;  ///< index of the scan
  Time stamp;
  SE3 T_odom_base;   ///< odometry when it was made; never changes
  SE3 T_map_base;    ///< after the last optimisation
  double way_m = 0;  ///< of the odometry, from the first key scan to here
  // Undistorted, in the lidar frame at `stamp`.
  SharedCloud features_lidar;    ///< planar points, thinned
  SharedCloud map_points_lidar;  ///< what the map shows
  SharedCloud points_lidar;      ///< the whole scan, for its descriptor; null once that is made
  Information information;
};

}  // namespace vsslam

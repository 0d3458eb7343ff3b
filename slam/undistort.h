// Motion compensation: every return moved to where the sensor would have seen it at the scan's stamp.
#pragma once

#include "core/samples.h"
#include "slam/inertial/motion_prior.h"
#include "slam/lidar/cloud.h"

namespace vsslam {

/// p_lidar(stamp) = T_lidar(stamp)_lidar(t) p_lidar(t), with rotation and translation of the motion
/// T_begin_t (base) since scan.stamp. One point per scan.points, same order.
Cloud undistort(const LidarScan& scan, const MotionPath& path, const SE3& T_base_lidar);

}  // namespace vsslam

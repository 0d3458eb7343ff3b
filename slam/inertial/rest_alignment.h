// Which way is up, and the biases, from the samples before the first scan.
#pragma once

#include <deque>

#include "core/calibration.h"
#include "core/samples.h"
#include "slam/inertial/motion_prior.h"

namespace vsslam {

struct RestAlignment {
  Quat q_odom_base = Quat::Identity();  ///< gravity along -z of odom; yaw 0
  Vec3 gyro_bias_radps = Vec3::Zero();  ///< IMU frame; zero unless at rest
  double gyro_bias_sigma_radps = 0.01;
  bool at_rest = false;
  bool no_gravity = false;   ///< the specific force is not about gravity: it was taken away, or is given in another unit
  bool upside_down = false;  ///< up in the base's frame points down: the mount is wrong
  /// IMU frame; zero unless at rest. What of it is level cannot be told from a tilt and is counted as such.
  Vec3 accel_bias_mps2 = Vec3::Zero();
};

/// What cannot be is not aligned by: level then. At rest the mean specific force points up. In motion the device's own orientation is used if there is one,
/// else the mean specific force as the best guess. Without samples: level.
RestAlignment align_at_rest(const std::deque<ImuSample>& samples, const ImuCalibration& imu,
                            const InertialConfig& config);

}  // namespace vsslam

// What the estimator may know of the robot: mounts, intrinsics and noise densities, as a calibration sheet
// would state them. Filled from the simulated rig or from a rig file of a real robot.
#pragma once

#include "core/se3.h"

namespace vsslam {

struct ImuCalibration {
  SE3 T_base_imu;
  double rate_hz = 100.0;
  double gyro_noise_radps_rthz = 1.745e-4;    ///< white noise density
  double accel_noise_mps2_rthz = 5.88e-4;
  double gyro_bias_walk_radps2_rthz = 1e-5;   ///< random walk density of the bias
  double accel_bias_walk_mps3_rthz = 1e-4;
  double gravity_mps2 = 9.80665;
};

struct LidarCalibration {
  SE3 T_base_lidar;
  int rings = 16;
  double mount_height_m = 0.6;  ///< of the LiDAR's origin above the ground
  double min_range_m = 1.0;
  double max_range_m = 100.0;
  double range_sigma_m = 0.007;
};

struct WheelCalibration {
  double wheel_radius_m = 0.16459;
  double effective_track_m = 0.9;  ///< of the differential-drive model that fits the skid-steered robot
};

/// Pinhole with radial-tangential distortion (OpenCV's k1 k2 p1 p2). Pixel centres have whole coordinates.
struct CameraCalibration {
  SE3 T_base_camera;  ///< camera frame: x right, y down, z forward
  int width_px = 640, height_px = 480;
  double fx_px = 384.2, fy_px = 384.2, cx_px = 319.5, cy_px = 236.4;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;
  double rate_hz = 30.0;
};

struct RigCalibration {
  LidarCalibration lidar;
  ImuCalibration imu;
  WheelCalibration wheels;
  CameraCalibration camera;
};

}  // namespace vsslam

// What sensors deliver, from the simulator or from a recording: the only door into slam/.
// No sample carries truth.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/se3.h"
#include "core/time.h"

namespace vsslam {

/// One return in the LiDAR frame of the moment it was fired (not undistorted). x forward, y left, z up.
struct LidarPoint {
  float x = 0, y = 0, z = 0;  ///< m
  float intensity = 0;        ///< reflectivity byte: 0-100 diffuse percent, 101-255 retro-reflective
  uint16_t ring = 0;          ///< 0 = lowest elevation
  float time_s = 0;           ///< seconds after the scan's stamp, >= 0
};

/// One revolution, in order of firing time. Every coordinate is finite; no return -> no point.
struct LidarScan {
  Time stamp;  ///< time of the first firing of the revolution
  Time end;    ///< time of the last firing
  std::vector<LidarPoint> points;
  bool rings_known = true;  ///< false: `ring` says nothing of the lasers
  bool times_known = true;  ///< false: every time_s is 0 or invented
};

/// Specific force and angular rate in the IMU frame.
struct ImuSample {
  Time stamp;
  Vec3 gyro_radps = Vec3::Zero();
  Vec3 accel_mps2 = Vec3::Zero();        ///< at rest +g along the axis that points up
  std::optional<Quat> q_earth_imu;       ///< the device's own orientation output (z up), if it has one
};

/// Accumulated wheel rotation since power-on; left and right are the means of the front and rear wheel.
struct WheelSample {
  Time stamp;
  double left_rad = 0;
  double right_rad = 0;
};

/// Grey image, row-major, 8 bits, stamped at mid-exposure.
struct CameraFrame {
  Time stamp;
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> grey;
};

}  // namespace vsslam

// Online estimate of the gyroscope's bias from the rotations that the LiDAR has seen.
#pragma once

#include "core/calibration.h"
#include "core/se3.h"

namespace vsslam {

/// A Kalman filter per axis with a common variance: the bias walks, a pair of scans measures it.
class GyroBias {
 public:
  GyroBias(double walk_radps2_rthz, double lidar_sigma_rad)
      : walk_(walk_radps2_rthz), lidar_sigma_rad_(lidar_sigma_rad) {}

  void start(const Vec3& bias_radps, double sigma_radps) {
    bias_radps_ = bias_radps;
    variance_ = sigma_radps * sigma_radps;
  }
  /// `rotation_error` = Log(R_gyro^-1 R_lidar) over dt_s, IMU frame, where R_gyro was integrated with bias();
  /// `observed` projects on the rotations that the LiDAR sees.
  void correct(const Vec3& rotation_error, const Mat3& observed, double dt_s);

  const Vec3& bias_radps() const { return bias_radps_; }

 private:
  double walk_, lidar_sigma_rad_;
  Vec3 bias_radps_ = Vec3::Zero();
  double variance_ = 1e-4;
};

}  // namespace vsslam

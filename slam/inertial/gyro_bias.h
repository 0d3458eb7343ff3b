// Online estimate of the gyroscope's bias from the rotations that the LiDAR has seen.
#pragma once

#include "core/calibration.h"
#include "core/se3.h"

namespace vsslam {

/// A Kalman filter per axis with a common variance: the bias walks, a pair of scans measures it.
class GyroBias {
 public:
  explicit GyroBias(double walk_radps2_rthz) : walk_(walk_radps2_rthz) {}

  void start(const Vec3& bias_radps, double sigma_radps) {
    bias_radps_ = bias_radps;
    variance_ = sigma_radps * sigma_radps;
  }
  /// `rotation_error` = Log(R_gyro^-1 R_lidar) over dt_s, IMU frame, where R_gyro was integrated with bias();
  /// `observed` projects on the rotations that the LiDAR sees, each pose with the standard deviation `lidar_sigma_rad`.
  void correct(const Vec3& rotation_error, const Mat3& observed, double lidar_sigma_rad, double dt_s);

  const Vec3& bias_radps() const { return bias_radps_; }
  double variance() const { return variance_; }  ///< rad^2/s^2, of each axis

 private:
  double walk_;
  Vec3 bias_radps_ = Vec3::Zero();
  double variance_ = 1e-4;
};

}  // namespace vsslam

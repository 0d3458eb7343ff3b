// IMU preintegration between two instants (Forster et al., T-RO 2017; mid-point as in Qin et al., T-RO 2018).
#pragma once

#include "core/calibration.h"
#include "core/se3.h"

namespace vsslam {

struct ImuBias {
  Vec3 gyro_radps = Vec3::Zero();
  Vec3 accel_mps2 = Vec3::Zero();
};

/// Relative motion of the IMU between instants i and j, free of gravity and of the velocity at i:
///   R_odom_j = R_odom_i delta_R
///   v_j = v_i + g dt + R_odom_i delta_v
///   p_j = p_i + v_i dt + 1/2 g dt^2 + R_odom_i delta_p
/// Errors are [phi; v; p] with delta_R Exp(phi).
class ImuPreintegration {
 public:
  using Mat9 = Eigen::Matrix<double, 9, 9>;
  using Mat9x6 = Eigen::Matrix<double, 9, 6>;

  ImuPreintegration(const ImuCalibration& imu, const ImuBias& bias) : imu_(imu), bias_(bias) {}

  /// Measurements at both ends of an interval of dt_s > 0, in the IMU frame, biases included.
  void add(double dt_s, const Vec3& gyro0_radps, const Vec3& accel0_mps2, const Vec3& gyro1_radps,
           const Vec3& accel1_mps2);

  double dt_s() const { return dt_s_; }
  const Quat& delta_R() const { return delta_R_; }
  const Vec3& delta_v() const { return delta_v_; }
  const Vec3& delta_p() const { return delta_p_; }
  const ImuBias& bias() const { return bias_; }
  /// Of the errors [phi; v; p], from the white noise of the calibration.
  const Mat9& covariance() const { return covariance_; }
  /// d[phi; v; p] / d[gyro bias; accel bias].
  const Mat9x6& bias_jacobian() const { return bias_jacobian_; }
  /// First-order result for another bias.
  ImuPreintegration corrected(const ImuBias& bias) const;

 private:
  ImuCalibration imu_;
  ImuBias bias_;
  double dt_s_ = 0;
  Quat delta_R_ = Quat::Identity();
  Vec3 delta_v_ = Vec3::Zero(), delta_p_ = Vec3::Zero();
  Mat9 covariance_ = Mat9::Zero();
  Mat9x6 bias_jacobian_ = Mat9x6::Zero();
};

}  // namespace vsslam

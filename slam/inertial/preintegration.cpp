#include "slam/inertial/preintegration.h"

namespace vsslam {

namespace {

// Error propagation of one mid-point step: e1 = F e0 + B n, n = [gyro; accel] in the mean of the interval.
struct ErrorStep {
  ImuPreintegration::Mat9 F = ImuPreintegration::Mat9::Identity();
  ImuPreintegration::Mat9x6 B = ImuPreintegration::Mat9x6::Zero();
};

ErrorStep error_step(double dt, const Vec3& rotation, const Mat3& R0, const Mat3& R1, const Vec3& a0,
                     const Vec3& a1) {
  const Mat3 turn_back = so3_exp(-rotation).toRotationMatrix();
  const Mat3 J_phi_n = so3_right_jacobian(rotation) * dt;
  const Mat3 J_a_phi = -0.5 * (R0 * hat(a0) + R1 * hat(a1) * turn_back);
  const Mat3 J_a_gyro = -0.5 * R1 * hat(a1) * J_phi_n;
  const Mat3 J_a_accel = 0.5 * (R0 + R1);
  ErrorStep step;
  step.F.block<3, 3>(0, 0) = turn_back;
  step.F.block<3, 3>(3, 0) = dt * J_a_phi;
  step.F.block<3, 3>(6, 0) = 0.5 * dt * dt * J_a_phi;
  step.F.block<3, 3>(6, 3) = dt * Mat3::Identity();
  step.B.block<3, 3>(0, 0) = J_phi_n;
  step.B.block<3, 3>(3, 0) = dt * J_a_gyro;
  step.B.block<3, 3>(6, 0) = 0.5 * dt * dt * J_a_gyro;
  step.B.block<3, 3>(3, 3) = dt * J_a_accel;
  step.B.block<3, 3>(6, 3) = 0.5 * dt * dt * J_a_accel;
  return step;
}

}  // namespace

void ImuPreintegration::add(double dt_s, const Vec3& gyro0_radps, const Vec3& accel0_mps2,
                            const Vec3& gyro1_radps, const Vec3& accel1_mps2) {
  const Vec3 rotation = (0.5 * (gyro0_radps + gyro1_radps) - bias_.gyro_radps) * dt_s;
  const Vec3 a0 = accel0_mps2 - bias_.accel_mps2, a1 = accel1_mps2 - bias_.accel_mps2;
  const Mat3 R0 = delta_R_.toRotationMatrix();
  const Quat q1 = (delta_R_ * so3_exp(rotation)).normalized();
  const Mat3 R1 = q1.toRotationMatrix();
  const Vec3 a = 0.5 * (R0 * a0 + R1 * a1);

  const ErrorStep step = error_step(dt_s, rotation, R0, R1, a0, a1);
  Vec6 noise;  // variance of the mean over dt of white noise of a given density
  noise << Vec3::Constant(imu_.gyro_noise_radps_rthz * imu_.gyro_noise_radps_rthz / dt_s),
      Vec3::Constant(imu_.accel_noise_mps2_rthz * imu_.accel_noise_mps2_rthz / dt_s);
  covariance_ = step.F * covariance_ * step.F.transpose() + step.B * noise.asDiagonal() * step.B.transpose();
  bias_jacobian_ = step.F * bias_jacobian_ - step.B;

  delta_p_ += delta_v_ * dt_s + 0.5 * a * dt_s * dt_s;
  delta_v_ += a * dt_s;
  delta_R_ = q1;
  dt_s_ += dt_s;
}

ImuPreintegration ImuPreintegration::corrected(const ImuBias& bias) const {
  Vec6 change;
  change << bias.gyro_radps - bias_.gyro_radps, bias.accel_mps2 - bias_.accel_mps2;
  const Eigen::Matrix<double, 9, 1> error = bias_jacobian_ * change;
  ImuPreintegration out = *this;
  out.bias_ = bias;
  out.delta_R_ = (delta_R_ * so3_exp(error.head<3>())).normalized();
  out.delta_v_ += error.segment<3>(3);
  out.delta_p_ += error.tail<3>();
  return out;
}

}  // namespace vsslam

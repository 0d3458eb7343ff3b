#include "slam/vio/rest_factor.h"

#include <algorithm>
#include <cmath>

#include "slam/vio/window_values.h"

namespace vsslam {

namespace {

// How still a robot at rest stands: what its suspension and people walking by leave. Judgement.
constexpr double kRotationSigma_rad = 2e-4, kPositionSigma_m = 5e-4, kVelocitySigma_mps = 4e-3;

}  // namespace

RestFactor::RestFactor(const RestMeans& means, double between_s, const ImuCalibration& imu)
    : means_(means), up_force_vio_(0, 0, imu.gravity_mps2) {
  const double root_s = std::sqrt(between_s), root_mean_s = std::sqrt(means.duration_s);
  weights_ << Vec3::Constant(1 / kRotationSigma_rad), Vec3::Constant(1 / kPositionSigma_m),
      Eigen::Matrix<double, 6, 1>::Constant(1 / kVelocitySigma_mps),
      Vec3::Constant(root_mean_s / imu.gyro_noise_radps_rthz),
      Vec3::Constant(root_mean_s / imu.accel_noise_mps2_rthz),
      Vec3::Constant(1 / (imu.gyro_bias_walk_radps2_rthz * root_s)),
      Vec3::Constant(1 / (imu.accel_bias_walk_mps3_rthz * root_s));
}

bool RestFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const SE3 T_i = pose_of(parameters[0]), T_j = pose_of(parameters[2]);
  const MotionMap m_i(parameters[1]), m_j(parameters[3]);
  const SE3 T_i_j = T_i.inverse() * T_j;
  const Vec6 moved = T_i_j.log();
  const Vec3 force_imu = T_j.rotation.conjugate() * up_force_vio_;
  Eigen::Matrix<double, 24, 1> e;
  e << moved, m_i.head<3>(), m_j.head<3>(), m_j.segment<3>(3) - means_.gyro_radps,
      force_imu + m_j.tail<3>() - means_.accel_mps2, m_j.tail<6>() - m_i.tail<6>();
  Eigen::Map<Eigen::Matrix<double, 24, 1>>{residuals} = weights_.cwiseProduct(e);
  if (!jacobians) return true;

  const Mat6 slope = se3_right_jacobian_inverse(moved);
  if (jacobians[0] || jacobians[2]) {
    Eigen::Matrix<double, 24, 6> J_i = Eigen::Matrix<double, 24, 6>::Zero(), J_j = J_i;
    J_i.topRows<6>() = -slope * T_i_j.inverse().adjoint();
    J_j.topRows<6>() = slope;
    J_j.block<3, 3>(15, 0) = hat(force_imu);
    if (jacobians[0]) put_pose_jacobian<24>(weights_.asDiagonal() * J_i, jacobians[0]);
    if (jacobians[2]) put_pose_jacobian<24>(weights_.asDiagonal() * J_j, jacobians[2]);
  }
  if (jacobians[1] || jacobians[3]) {
    Eigen::Matrix<double, 24, 9> J_i = Eigen::Matrix<double, 24, 9>::Zero(), J_j = J_i;
    J_i.block<3, 3>(6, 0).setIdentity();
    J_i.block<6, 6>(18, 3) = -Mat6::Identity();
    J_j.block<3, 3>(9, 0).setIdentity();
    J_j.block<3, 3>(12, 3).setIdentity();
    J_j.block<3, 3>(15, 6).setIdentity();
    J_j.block<6, 6>(18, 3).setIdentity();
    if (jacobians[1]) put_motion_jacobian<24>(weights_.asDiagonal() * J_i, jacobians[1]);
    if (jacobians[3]) put_motion_jacobian<24>(weights_.asDiagonal() * J_j, jacobians[3]);
  }
  return true;
}

}  // namespace vsslam

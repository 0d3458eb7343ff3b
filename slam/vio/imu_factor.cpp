#include "slam/vio/imu_factor.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "slam/vio/window_values.h"

namespace vsslam {

namespace {

using Mat15x6 = Eigen::Matrix<double, 15, 6>;
using Mat15x9 = Eigen::Matrix<double, 15, 9>;

}  // namespace

ImuFactor::ImuFactor(const ImuPreintegration& motion, const ImuCalibration& imu)
    : motion_(motion), g_vio_(0, 0, -imu.gravity_mps2) {
  const ImuPreintegration::Mat9 L = motion.covariance().llt().matrixL();
  whiten_ = L.triangularView<Eigen::Lower>().solve(ImuPreintegration::Mat9::Identity());
  gyro_walk_weight_ = 1.0 / (imu.gyro_bias_walk_radps2_rthz * std::sqrt(motion.dt_s()));
  accel_walk_weight_ = 1.0 / (imu.accel_bias_walk_mps3_rthz * std::sqrt(motion.dt_s()));
}

bool ImuFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const SE3 T_i = pose_of(parameters[0]), T_j = pose_of(parameters[2]);
  const MotionMap m_i(parameters[1]), m_j(parameters[3]);
  const double dt = motion_.dt_s();
  const Vec3 v_i = m_i.head<3>(), v_j = m_j.head<3>();
  Vec6 bias_change;
  bias_change << m_i.segment<3>(3) - motion_.bias().gyro_radps, m_i.tail<3>() - motion_.bias().accel_mps2;
  const Eigen::Matrix<double, 9, 1> change = motion_.bias_jacobian() * bias_change;
  const Mat3 R_i = T_i.matrix3(), R_j = T_j.matrix3(), back = R_i.transpose();
  const Vec3 turned = change.head<3>();
  const Quat E = (motion_.delta_R() * so3_exp(turned)).conjugate() * T_i.rotation.conjugate() * T_j.rotation;
  const Vec3 e_phi = so3_log(E);
  const Vec3 dv = back * (v_j - v_i - g_vio_ * dt);
  const Vec3 dp = back * (T_j.translation - T_i.translation - v_i * dt - 0.5 * dt * dt * g_vio_);

  Eigen::Matrix<double, 9, 1> e;
  e << e_phi, dv - motion_.delta_v() - change.segment<3>(3), dp - motion_.delta_p() - change.tail<3>();
  Eigen::Map<Eigen::Matrix<double, 15, 1>> r(residuals);
  r.head<9>() = whiten_ * e;
  r.segment<3>(9) = gyro_walk_weight_ * (m_j.segment<3>(3) - m_i.segment<3>(3));
  r.tail<3>() = accel_walk_weight_ * (m_j.tail<3>() - m_i.tail<3>());
  if (!jacobians) return true;

  const Mat3 slope = so3_right_jacobian_inverse(e_phi);
  const auto white = [&](auto& J) { J.template topRows<9>() = (whiten_ * J.template topRows<9>()).eval(); };
  if (jacobians[0]) {
    Mat15x6 J = Mat15x6::Zero();
    J.block<3, 3>(0, 0) = -slope * R_j.transpose() * R_i;
    J.block<3, 3>(3, 0) = hat(dv);
    J.block<3, 3>(6, 0) = hat(dp);
    J.block<3, 3>(6, 3) = -Mat3::Identity();
    white(J);
    put_pose_jacobian<15>(J, jacobians[0]);
  }
  if (jacobians[1]) {
    Mat15x9 J = Mat15x9::Zero();
    J.block<3, 3>(3, 0) = -back;
    J.block<3, 3>(6, 0) = -dt * back;
    J.block<9, 6>(0, 3) = -motion_.bias_jacobian();
    J.block<3, 6>(0, 3) =
        slope * E.conjugate().toRotationMatrix() * so3_right_jacobian(turned) * J.block<3, 6>(0, 3);
    white(J);
    J.block<3, 3>(9, 3) = -gyro_walk_weight_ * Mat3::Identity();
    J.block<3, 3>(12, 6) = -accel_walk_weight_ * Mat3::Identity();
    put_motion_jacobian<15>(J, jacobians[1]);
  }
  if (jacobians[2]) {
    Mat15x6 J = Mat15x6::Zero();
    J.block<3, 3>(0, 0) = slope;
    J.block<3, 3>(6, 3) = back * R_j;
    white(J);
    put_pose_jacobian<15>(J, jacobians[2]);
  }
  if (jacobians[3]) {
    Mat15x9 J = Mat15x9::Zero();
    J.block<3, 3>(3, 0) = back;
    white(J);
    J.block<3, 3>(9, 3) = gyro_walk_weight_ * Mat3::Identity();
    J.block<3, 3>(12, 6) = accel_walk_weight_ * Mat3::Identity();
    put_motion_jacobian<15>(J, jacobians[3]);
  }
  return true;
}

}  // namespace vsslam

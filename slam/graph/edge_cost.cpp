#include "slam/graph/edge_cost.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace vsslam {

namespace {

using RowJacobian = Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>;

SE3 pose_at(const double* x) {
  SE3 pose;
  pose.rotation = Eigen::Map<const Quat>(x);
  pose.translation = Eigen::Map<const Vec3>(x + 4);
  return pose;
}

void put(const SE3& pose, double* x) {
  Eigen::Map<Quat>{x} = pose.rotation;
  Eigen::Map<Vec3>{x + 4} = pose.translation;
}

void put_tangent(const Mat6& derivative, double* jacobian) {
  RowJacobian out(jacobian);
  out.leftCols<6>() = derivative;
  out.col(6).setZero();
}

}  // namespace

PoseBlock to_block(const SE3& pose) {
  PoseBlock block;
  put(pose, block.data());
  return block;
}

SE3 from_block(const PoseBlock& block) {
  return pose_at(block.data());
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  put(pose_at(x) * SE3::exp(Eigen::Map<const Vec6>(delta)), x_plus_delta);
  return true;
}

bool PoseManifold::PlusJacobian(const double*, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vec6>{y_minus_x} = (pose_at(x).inverse() * pose_at(y)).log();
  return true;
}

bool PoseManifold::MinusJacobian(const double*, double* jacobian) const {
  RowJacobian(jacobian).setIdentity();
  return true;
}

EdgeCost::EdgeCost(const SE3& T_from_to, const Mat6& information)
    : T_to_from_(T_from_to.inverse()), square_root_(information.llt().matrixU()) {}

bool EdgeCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const SE3 T_i_j = pose_at(parameters[0]).inverse() * pose_at(parameters[1]);
  const Vec6 error = (T_to_from_ * T_i_j).log();
  Eigen::Map<Vec6>{residuals} = square_root_ * error;
  if (!jacobians) return true;
  const Mat6 slope = square_root_ * se3_right_jacobian_inverse(error);
  if (jacobians[0]) put_tangent(-slope * T_i_j.inverse().adjoint(), jacobians[0]);
  if (jacobians[1]) put_tangent(slope, jacobians[1]);
  return true;
}

}  // namespace vsslam

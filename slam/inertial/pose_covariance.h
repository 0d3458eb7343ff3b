// Covariances of poses, and what a better known pose says of the rest of a state.
#pragma once

#include <Eigen/Cholesky>

#include "core/se3.h"

namespace vsslam {

/// Of T_odom_b = T_odom_a T_a_b with T_a_b exact: right perturbations [rotation; translation] of b from those of a.
inline Mat6 moved_covariance(const Mat6& covariance_a, const SE3& T_a_b) {
  const Mat6 Ad_b_a = T_a_b.inverse().adjoint();
  return Ad_b_a * covariance_a * Ad_b_a.transpose();
}

/// That of a state whose first six errors, of a pose, are none: how the rest errs, and through it the motion from there on.
template <int N>
Eigen::Matrix<double, N, N> of_exact_pose(Eigen::Matrix<double, N, N> P) {
  P.template topRows<6>().setZero();
  P.template leftCols<6>().setZero();
  return P;
}

/// A state of N errors, of which the first six are of a pose, has the covariance P. The pose turns out to be off by
/// `shift` and to be known with `posterior`. What that tells of the rest: since the measurement depends on the pose
/// alone, the rest given the pose stays as it was. With K = P_rp P_pp^-1:
///   E[rest] = K shift,  P_rr - K (P_pp - posterior) K',  P_rp = K posterior.
/// Returns the shift of the whole state; P becomes its covariance.
template <int N>
Eigen::Matrix<double, N, 1> condition_on_pose(Eigen::Matrix<double, N, N>& P, const Vec6& shift,
                                              const Mat6& posterior) {
  constexpr int kRest = N - 6;
  const Mat6 P_pp = P.template topLeftCorner<6, 6>();
  const Eigen::Matrix<double, kRest, 6> K =
      P_pp.ldlt().solve(P.template topRightCorner<6, kRest>()).transpose();
  P.template bottomRightCorner<kRest, kRest>() -= K * (P_pp - posterior) * K.transpose();
  P.template bottomLeftCorner<kRest, 6>() = K * posterior;
  P.template topRightCorner<6, kRest>() = P.template bottomLeftCorner<kRest, 6>().transpose();
  P.template topLeftCorner<6, 6>() = posterior;
  Eigen::Matrix<double, N, 1> whole;
  whole << shift, K * shift;
  return whole;
}

}  // namespace vsslam

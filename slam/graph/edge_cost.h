// A pose-graph edge for Ceres: error, analytic Jacobians and the manifold of poses.
//
// With E = Z^-1 T_i^-1 T_j, e = Log(E) and right perturbations T * Exp(xi):
//   T_j:  E Exp(xi_j)                       ->  de/dxi_j =  J_r^-1(e)
//   T_i:  E Exp(-Ad(T_j^-1 T_i) xi_i)       ->  de/dxi_i = -J_r^-1(e) Ad(T_j^-1 T_i)
#pragma once

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>

#include <array>

#include "core/se3.h"

namespace vsslam {

/// x y z w of the quaternion, then the translation.
using PoseBlock = std::array<double, 7>;
PoseBlock to_block(const SE3& pose);
SE3 from_block(const PoseBlock& block);

/// T * Exp(xi). Costs that use it write their 6 tangent derivatives into the first 6 columns of the 7 that
/// Ceres asks for: PlusJacobian [I; 0] hands them through unchanged.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// Residual L^T e with information = L L^T.
class EdgeCost final : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  EdgeCost(const SE3& T_from_to, const Mat6& information);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  SE3 T_to_from_;
  Mat6 square_root_;  // L^T
};

}  // namespace vsslam

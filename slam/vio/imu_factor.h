// Two consecutive states and the IMU between them (Forster et al., T-RO 2017, section VI).
#pragma once

#include <ceres/sized_cost_function.h>

#include "slam/inertial/preintegration.h"

namespace vsslam {

/// Variables: pose and motion of frame i, pose and motion of frame j; a pose is the PoseBlock of T_vio_imu, a
/// motion is [velocity; gyro bias; accel bias]. Residuals, whitened:
///   Log(delta_R^T R_i^T R_j), R_i^T (v_j - v_i - g dt) - delta_v,
///   R_i^T (p_j - p_i - v_i dt - 1/2 g dt^2) - delta_p, steps of the gyro bias and of the accel bias.
/// The deltas follow the bias of frame i to first order.
class ImuFactor final : public ceres::SizedCostFunction<15, 7, 9, 7, 9> {
 public:
  /// `motion` is not copied.
  ImuFactor(const ImuPreintegration& motion, const ImuCalibration& imu);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const ImuPreintegration& motion_;
  Vec3 g_vio_;
  ImuPreintegration::Mat9 whiten_;  // L^-1 of covariance = L L^T
  double gyro_walk_weight_, accel_walk_weight_;
};

}  // namespace vsslam

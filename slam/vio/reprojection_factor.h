// A feature in the frame of its anchor and in another frame.
//
// With the point's ray a = (x, y, 1) and inverse depth rho = 1 / z in the anchor, everything is scaled by rho, so that
// points at infinity (rho = 0) are as good as others:
//   rho X_imu_i = R_imu_camera a + rho t_imu_camera
//   rho (X_vio - p_j) = R_i (rho X_imu_i) + rho (p_i - p_j)
//   y = R_camera_imu (R_j^T (rho (X_vio - p_j)) - rho t_imu_camera),   seen at (y_x / y_z, y_y / y_z), depth y_z / rho
#pragma once

#include <ceres/sized_cost_function.h>

#include "core/se3.h"
#include "slam/vio/window_values.h"

namespace vsslam {

/// y above: the feature in the camera of frame j, times rho.
Vec3 scaled_point_camera(const SE3& T_vio_i, const SE3& T_vio_j, const SE3& T_imu_camera,
                         const InversePoint& point_anchor);

/// Variables: pose of the anchor i, pose of frame j, point in the anchor. `weight`: 1 / sigma on the plane z = 1.
class ReprojectionFactor final : public ceres::SizedCostFunction<2, 7, 7, 3> {
 public:
  ReprojectionFactor(const SE3& T_imu_camera, const Vec2& ray_seen, double weight)
      : T_imu_camera_(T_imu_camera), ray_seen_(ray_seen), weight_(weight) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  SE3 T_imu_camera_;
  Vec2 ray_seen_;
  double weight_;
};

/// The same in the anchor, where the ray is the point's own. Variable: point.
class AnchorRayFactor final : public ceres::SizedCostFunction<2, 3> {
 public:
  AnchorRayFactor(const Vec2& ray_seen, double weight) : ray_seen_(ray_seen), weight_(weight) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Vec2 ray_seen_;
  double weight_;
};

/// The LiDAR's depth in frame j: (rho depth - y_z) / sigma_ratio. Variables as above. A second row is always 0: where
/// all factors of two poses and a point have two rows, one path made for these sizes adds them up.
class DepthFactor final : public ceres::SizedCostFunction<2, 7, 7, 3> {
 public:
  DepthFactor(const SE3& T_imu_camera, double depth_m, double sigma_ratio)
      : T_imu_camera_(T_imu_camera), depth_m_(depth_m), weight_(1.0 / sigma_ratio) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  SE3 T_imu_camera_;
  double depth_m_, weight_;
};

/// The same in the anchor, where y_z = 1. Variable: point.
class AnchorDepthFactor final : public ceres::SizedCostFunction<1, 3> {
 public:
  AnchorDepthFactor(double depth_m, double sigma_ratio) : depth_m_(depth_m), weight_(1.0 / sigma_ratio) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  double depth_m_, weight_;
};

}  // namespace vsslam

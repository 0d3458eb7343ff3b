#include "slam/vio/reprojection_factor.h"

namespace vsslam {

namespace {

// Rows of d/d(pose i), d/d(pose j), d/d(point) for residuals whose derivative to y is `slope`.
struct ScaledPoint {
  Vec3 in_i, in_j, y;                  // rho X_imu_i, rho X_imu_j, y
  Mat3 R_camera_imu, R_i, R_camera_i;  // R_camera_i: from IMU i to camera j
  Mat3 d_point;

  ScaledPoint(double const* const* parameters, const SE3& T_imu_camera) {
    const SE3 T_i = pose_of(parameters[0]), T_j = pose_of(parameters[1]);
    const double rho = parameters[2][2];
    const Vec3& lever = T_imu_camera.translation;
    const Vec3 baseline = T_i.translation - T_j.translation;
    R_camera_imu = T_imu_camera.matrix3().transpose();
    R_i = T_i.matrix3();
    const Mat3 back = T_j.matrix3().transpose();
    in_i = R_camera_imu.transpose() * Vec3(parameters[2][0], parameters[2][1], 1) + rho * lever;
    in_j = back * (R_i * in_i + rho * baseline);
    y = R_camera_imu * (in_j - rho * lever);
    R_camera_i = R_camera_imu * back * R_i;
    d_point.leftCols<2>() = R_camera_i * R_camera_imu.transpose().leftCols<2>();
    d_point.col(2) = R_camera_imu * (back * (R_i * lever + baseline) - lever);
  }

  template <int kRows>
  void put(const Eigen::Matrix<double, kRows, 3>& slope, double rho, double** jacobians) const {
    using Pose = Eigen::Matrix<double, kRows, 6>;
    if (jacobians[0]) {
      Pose J;
      const Eigen::Matrix<double, kRows, 3> s = slope * R_camera_i;
      J << -s * hat(in_i), rho * s;
      put_pose_jacobian<kRows>(J, jacobians[0]);
    }
    if (jacobians[1]) {
      Pose J;
      const Eigen::Matrix<double, kRows, 3> s = slope * R_camera_imu;
      J << s * hat(in_j), -rho * s;
      put_pose_jacobian<kRows>(J, jacobians[1]);
    }
    if (jacobians[2])
      Eigen::Map<Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>>{jacobians[2]} = slope * d_point;
  }
};

// Nearer to the camera's plane than this, or behind it, a projection means nothing.
constexpr double kNearestScaledDepth = 0.05;

}  // namespace

Vec3 scaled_point_camera(const SE3& T_vio_i, const SE3& T_vio_j, const SE3& T_imu_camera,
                         const InversePoint& point_anchor) {
  const SE3 T_j_i = (T_vio_j * T_imu_camera).inverse() * (T_vio_i * T_imu_camera);
  return T_j_i.rotation * Vec3(point_anchor.x(), point_anchor.y(), 1) + point_anchor.z() * T_j_i.translation;
}

bool ReprojectionFactor::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const ScaledPoint point(parameters, T_imu_camera_);
  const bool visible = point.y.z() > kNearestScaledDepth;
  const double inverse_z = 1.0 / (visible ? point.y.z() : kNearestScaledDepth);
  const Vec2 seen = inverse_z * point.y.head<2>();
  Eigen::Map<Vec2>{residuals} = weight_ * (seen - ray_seen_);
  if (!jacobians) return true;
  Eigen::Matrix<double, 2, 3> slope = Eigen::Matrix<double, 2, 3>::Zero();
  if (visible) slope << inverse_z, 0, -inverse_z * seen.x(), 0, inverse_z, -inverse_z * seen.y();
  point.put<2>(weight_ * slope, parameters[2][2], jacobians);
  return true;
}

bool AnchorRayFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  Eigen::Map<Vec2>{residuals} = weight_ * (Eigen::Map<const Vec2>(parameters[0]) - ray_seen_);
  if (jacobians && jacobians[0])
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[0]} << weight_, 0, 0, 0, weight_, 0;
  return true;
}

bool DepthFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const ScaledPoint point(parameters, T_imu_camera_);
  Eigen::Map<Vec2>{residuals} = Vec2(weight_ * (parameters[2][2] * depth_m_ - point.y.z()), 0);
  if (!jacobians) return true;
  Eigen::Matrix<double, 2, 3> slope = Eigen::Matrix<double, 2, 3>::Zero();
  slope(0, 2) = -weight_;
  point.put<2>(slope, parameters[2][2], jacobians);
  if (jacobians[2]) jacobians[2][2] += weight_ * depth_m_;
  return true;
}

bool AnchorDepthFactor::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  residuals[0] = weight_ * (parameters[0][2] * depth_m_ - 1.0);
  if (jacobians && jacobians[0]) Eigen::Map<Vec3>{jacobians[0]} << 0, 0, weight_ * depth_m_;
  return true;
}

}  // namespace vsslam

// Rotations and rigid transforms.
//
// Conventions, stated once for the whole project:
//   T_a_b maps coordinates in frame b to coordinates in frame a; frames cancel: T_a_c = T_a_b * T_b_c.
//   A tangent vector is [rotation (rad); translation (m)]; perturbations are on the right: T * Exp(xi).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/time.h"

namespace vsslam {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat3 = Eigen::Matrix3d;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Quat = Eigen::Quaterniond;

/// [v]x, so that hat(v) * w = v x w.
Mat3 hat(const Vec3& v);
/// SO(3) exponential of a rotation vector (rad).
Quat so3_exp(const Vec3& phi);
/// Rotation vector with angle in [0, pi]. The sign of q does not matter.
Vec3 so3_log(const Quat& q);
/// J_r of SO(3): Exp(phi + dphi) ~ Exp(phi) Exp(J_r dphi).
Mat3 so3_right_jacobian(const Vec3& phi);
Mat3 so3_right_jacobian_inverse(const Vec3& phi);

/// A rigid transform. The rotation is a unit quaternion; products renormalise it.
struct SE3 {
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();

  SE3() = default;
  SE3(const Quat& q, const Vec3& t) : rotation(q.normalized()), translation(t) {}
  /// From roll, pitch, yaw in rad (R = Rz(yaw) Ry(pitch) Rx(roll)) and a translation in m.
  static SE3 from_rpy(const Vec3& rpy_rad, const Vec3& translation_m);
  /// Exponential of [rotation; translation].
  static SE3 exp(const Vec6& xi);

  Vec6 log() const;
  SE3 inverse() const;
  Mat3 matrix3() const { return rotation.toRotationMatrix(); }
  Eigen::Matrix4d matrix4() const;
  Vec3 operator*(const Vec3& p) const { return rotation * p + translation; }
  SE3 operator*(const SE3& other) const;
  /// Ad with T Exp(xi) T^-1 = Exp(Ad xi), tangent order [rotation; translation].
  Mat6 adjoint() const;
  /// Roll, pitch, yaw in rad, the inverse of from_rpy away from pitch = +-90 deg.
  Vec3 rpy() const;
  /// Rotation angle in rad, in [0, pi].
  double angle() const { return so3_log(rotation).norm(); }
};

/// J_r of SE(3), the inverse: Log(T Exp(d)) ~ Log(T) + J_r^-1(Log T) d.
Mat6 se3_right_jacobian_inverse(const Vec6& xi);

/// Geodesic on SO(3) x R^3 from a (u = 0) to b (u = 1).
SE3 interpolate(const SE3& a, const SE3& b, double u);

/// A pose with its stamp; the frames are named by the container's name.
struct StampedPose {
  Time stamp;
  SE3 pose;
};

}  // namespace vsslam

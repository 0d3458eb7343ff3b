#include "core/se3.h"

#include <cmath>

namespace vsslam {

namespace {
constexpr double kSmallAngle = 1e-5;  // below this the series are exact to double precision
}

Mat3 hat(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Quat so3_exp(const Vec3& phi) {
  const double angle = phi.norm();
  const double half_sinc = angle < kSmallAngle ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Quat q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = half_sinc * phi;
  return q.normalized();
}

Vec3 so3_log(const Quat& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double w = sign * q.w();
  const Vec3 v = sign * q.vec();
  const double sine = v.norm();
  if (sine < kSmallAngle) return v * (2.0 / w * (1.0 - sine * sine / (3.0 * w * w)));
  return v * (2.0 * std::atan2(sine, w) / sine);
}

Mat3 so3_right_jacobian(const Vec3& phi) {
  const double a = phi.norm();
  const Mat3 h = hat(phi);
  if (a < kSmallAngle) return Mat3::Identity() - 0.5 * h + h * h / 6.0;
  return Mat3::Identity() - (1.0 - std::cos(a)) / (a * a) * h + (a - std::sin(a)) / (a * a * a) * h * h;
}

Mat3 so3_right_jacobian_inverse(const Vec3& phi) {
  const double a = phi.norm();
  const Mat3 h = hat(phi);
  if (a < kSmallAngle) return Mat3::Identity() + 0.5 * h + h * h / 12.0;
  const double half_cot = 0.5 * a * std::cos(0.5 * a) / std::sin(0.5 * a);
  return Mat3::Identity() + 0.5 * h + (1.0 - half_cot) / (a * a) * h * h;
}

SE3 SE3::from_rpy(const Vec3& rpy_rad, const Vec3& translation_m) {
  using Eigen::AngleAxisd;
  return {Quat(AngleAxisd(rpy_rad.z(), Vec3::UnitZ()) * AngleAxisd(rpy_rad.y(), Vec3::UnitY()) *
               AngleAxisd(rpy_rad.x(), Vec3::UnitX())),
          translation_m};
}

SE3 SE3::exp(const Vec6& xi) {
  const Vec3 phi = xi.head<3>();
  // The left Jacobian is the right Jacobian of -phi.
  return {so3_exp(phi), so3_right_jacobian(-phi) * xi.tail<3>()};
}

Vec6 SE3::log() const {
  Vec6 xi;
  const Vec3 phi = so3_log(rotation);
  xi << phi, so3_right_jacobian_inverse(-phi) * translation;
  return xi;
}

SE3 SE3::inverse() const {
  const Quat inverse_rotation = rotation.conjugate();
  return {inverse_rotation, -(inverse_rotation * translation)};
}

Eigen::Matrix4d SE3::matrix4() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = matrix3();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

SE3 SE3::operator*(const SE3& other) const {
  return {rotation * other.rotation, rotation * other.translation + translation};
}

Mat6 SE3::adjoint() const {
  const Mat3 r = matrix3();
  Mat6 ad = Mat6::Zero();
  ad.topLeftCorner<3, 3>() = r;
  ad.bottomRightCorner<3, 3>() = r;
  ad.bottomLeftCorner<3, 3>() = hat(translation) * r;
  return ad;
}

Vec3 SE3::rpy() const {
  const Mat3 r = matrix3();
  return {std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2))),
          std::atan2(r(1, 0), r(0, 0))};
}

namespace {

// Q of the left Jacobian of SE(3); Barfoot, "State Estimation for Robotics", (7.86).
Mat3 left_jacobian_coupling(const Vec3& phi, const Vec3& rho) {
  const double a = phi.norm(), a2 = a * a;
  const Mat3 p = hat(phi), r = hat(rho);
  double c1 = 1.0 / 6.0 - a2 / 120.0, c2 = 1.0 / 24.0 - a2 / 720.0, c3 = 1.0 / 120.0 - a2 / 2520.0;
  if (a > 1e-2) {  // the closed forms cancel below this, where the series are exact to 1e-10
    const double s = std::sin(a), c = std::cos(a);
    c1 = (a - s) / (a2 * a);
    c2 = (a2 + 2.0 * c - 2.0) / (2.0 * a2 * a2);
    c3 = (2.0 * a - 3.0 * s + a * c) / (2.0 * a2 * a2 * a);
  }
  return 0.5 * r + c1 * (p * r + r * p + p * r * p) + c2 * (p * p * r + r * p * p - 3.0 * p * r * p) +
         c3 * (p * r * p * p + p * p * r * p);
}

}  // namespace

Mat6 se3_right_jacobian_inverse(const Vec6& xi) {
  const Vec3 phi = -xi.head<3>(), rho = -xi.tail<3>();  // J_r(xi) = J_l(-xi)
  const Mat3 j_inverse = so3_right_jacobian_inverse(-phi);
  Mat6 out = Mat6::Zero();
  out.topLeftCorner<3, 3>() = j_inverse;
  out.bottomRightCorner<3, 3>() = j_inverse;
  out.bottomLeftCorner<3, 3>() = -j_inverse * left_jacobian_coupling(phi, rho) * j_inverse;
  return out;
}

SE3 interpolate(const SE3& a, const SE3& b, double u) {
  const Vec3 phi = so3_log(a.rotation.conjugate() * b.rotation);
  return {a.rotation * so3_exp(u * phi), a.translation + u * (b.translation - a.translation)};
}

}  // namespace vsslam

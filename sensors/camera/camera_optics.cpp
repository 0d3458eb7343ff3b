#include "sensors/camera/camera_optics.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace vsslam {

CameraOptics::CameraOptics(const CameraConfig& c)
    : width_px_(c.width_px),
      height_px_(c.height_px),
      focal_px_(c.fx_px, c.fy_px),
      centre_px_(c.cx_px, c.cy_px),
      k1_(c.k1),
      k2_(c.k2),
      p1_(c.p1),
      p2_(c.p2),
      distorted_(c.k1 != 0 || c.k2 != 0 || c.p1 != 0 || c.p2 != 0) {}

// x' = x (1 + k1 r^2 + k2 r^4) + 2 p1 x y + p2 (r^2 + 2 x^2), y' alike with p1 and p2 exchanged.
Vec2 CameraOptics::distort(const Vec2& ideal) const {
  const double x = ideal.x(), y = ideal.y(), r2 = ideal.squaredNorm();
  const double radial = 1 + r2 * (k1_ + r2 * k2_);
  return {x * radial + 2 * p1_ * x * y + p2_ * (r2 + 2 * x * x),
          y * radial + 2 * p2_ * x * y + p1_ * (r2 + 2 * y * y)};
}

Eigen::Matrix2d CameraOptics::distortion_jacobian(const Vec2& ideal) const {
  const double x = ideal.x(), y = ideal.y(), r2 = ideal.squaredNorm();
  const double radial = 1 + r2 * (k1_ + r2 * k2_), slope = 2 * k1_ + 4 * k2_ * r2;
  const double mixed = x * y * slope + 2 * p1_ * x + 2 * p2_ * y;
  Eigen::Matrix2d J;
  J << radial + x * x * slope + 2 * p1_ * y + 6 * p2_ * x, mixed, mixed,
      radial + y * y * slope + 2 * p2_ * x + 6 * p1_ * y;
  return J;
}

// Newton. A fold of the distortion (no positive determinant on the way) has no single inverse.
Vec2 CameraOptics::undistort(const Vec2& distorted) const {
  Vec2 ideal = distorted;
  for (int i = 0; i < 50; ++i) {
    const Vec2 residual = distorted - distort(ideal);
    const Eigen::Matrix2d J = distortion_jacobian(ideal);
    if (!(J.determinant() > 0)) break;
    if (residual.cwiseAbs().maxCoeff() < 1e-13) return ideal;
    ideal += J.inverse() * residual;
  }
  const Vec2 pixel = focal_px_.cwiseProduct(distorted) + centre_px_;
  throw InputError(fmt::format(
      "rig.sensors.camera: the distortion k1 {} k2 {} p1 {} p2 {} has no inverse at pixel ({:.0f}, {:.0f})",
      k1_, k2_, p1_, p2_, pixel.x(), pixel.y()));
}

std::optional<Vec2> CameraOptics::project(const Vec3& p_camera) const {
  if (!(p_camera.z() > 0)) return std::nullopt;
  const Vec2 ideal = p_camera.head<2>() / p_camera.z();
  return focal_px_.cwiseProduct(distorted_ ? distort(ideal) : ideal) + centre_px_;
}

Vec3 CameraOptics::ray(const Vec2& pixel) const {
  const Vec2 distorted = (pixel - centre_px_).cwiseQuotient(focal_px_);
  return (distorted_ ? undistort(distorted) : distorted).homogeneous().normalized();
}

ViewRays CameraOptics::grid(int width, int height, const Vec2& first_px, const Vec2& step_px) const {
  std::vector<Vec3f> directions;
  directions.reserve(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      directions.push_back(ray(first_px + step_px.cwiseProduct(Vec2(x, y))).cast<float>());
  return {width, height, std::move(directions), static_cast<float>(std::atan(step_px.x() / focal_px_.x()))};
}

ViewRays CameraOptics::rays(const Vec2& offset_px) const {
  return grid(width_px_, height_px_, offset_px, Vec2::Ones());
}

ViewRays CameraOptics::coarse_rays(int width, int height) const {
  const Vec2 step_px(static_cast<double>(width_px_ - 1) / (width - 1),
                     static_cast<double>(height_px_ - 1) / (height - 1));
  return grid(width, height, Vec2::Zero(), step_px);
}

}  // namespace vsslam

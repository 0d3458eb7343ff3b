#include "slam/vision/camera_model.h"

#include <Eigen/LU>

namespace vsslam {

// Brown's model in OpenCV's order of coefficients: x (1 + k1 r2 + k2 r4) + 2 p1 x y + p2 (r2 + 2 x2), y alike.
Vec2 CameraModel::distort(const Vec2& ray, Eigen::Matrix2d* jacobian) const {
  const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (c_.k1 + r2 * c_.k2);
  if (jacobian) {
    const double slope = c_.k1 + 2 * c_.k2 * r2;  // d radial / d r2
    (*jacobian)(0, 0) = radial + 2 * x * x * slope + 2 * c_.p1 * y + 6 * c_.p2 * x;
    (*jacobian)(0, 1) = 2 * x * y * slope + 2 * c_.p1 * x + 2 * c_.p2 * y;
    (*jacobian)(1, 0) = (*jacobian)(0, 1);
    (*jacobian)(1, 1) = radial + 2 * y * y * slope + 6 * c_.p1 * y + 2 * c_.p2 * x;
  }
  return {x * radial + 2 * c_.p1 * x * y + c_.p2 * (r2 + 2 * x * x),
          y * radial + c_.p1 * (r2 + 2 * y * y) + 2 * c_.p2 * x * y};
}

Vec2 CameraModel::pixel_px(const Vec2& ray_camera) const {
  const Vec2 distorted = distort(ray_camera, nullptr);
  return {c_.fx_px * distorted.x() + c_.cx_px, c_.fy_px * distorted.y() + c_.cy_px};
}

std::optional<Vec2> CameraModel::ray_camera(const Vec2& pixel_px) const {
  const Vec2 distorted((pixel_px.x() - c_.cx_px) / c_.fx_px, (pixel_px.y() - c_.cy_px) / c_.fy_px);
  if (c_.k1 == 0 && c_.k2 == 0 && c_.p1 == 0 && c_.p2 == 0) return distorted;
  Vec2 ray = distorted;
  for (int i = 0; i < 30; ++i) {  // Newton
    Eigen::Matrix2d jacobian;
    const Vec2 residual = distort(ray, &jacobian) - distorted;
    if (jacobian.determinant() <= 1e-3) return std::nullopt;  // the image turns back on itself here
    const Vec2 step = jacobian.inverse() * residual;
    ray -= step;
    if (step.squaredNorm() < 1e-24) return ray;
  }
  return std::nullopt;
}

}  // namespace vsslam

// Pinhole with radial-tangential distortion: from pixels to directions and back.
#pragma once

#include <optional>

#include "core/calibration.h"

namespace vsslam {

class CameraModel {
 public:
  explicit CameraModel(const CameraCalibration& calibration) : c_(calibration) {}

  /// Pixel of the direction (x / z, y / z), distortion included. Pixel (0, 0) is the centre of the first one.
  Vec2 pixel_px(const Vec2& ray_camera) const;
  /// The undistorted direction, exact to 1e-12; empty where the distortion has no inverse (far outside the
  /// image, or in the corners of a calibration that folds over there).
  std::optional<Vec2> ray_camera(const Vec2& pixel_px) const;

 private:
  Vec2 distort(const Vec2& ray, Eigen::Matrix2d* jacobian) const;
  CameraCalibration c_;
};

}  // namespace vsslam

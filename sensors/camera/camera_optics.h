// From directions to pixels and back: pinhole with radial-tangential distortion.
//
// Frame `camera`: x right, y down, z forward. Pixel centres have whole coordinates, (0, 0) is the top left pixel.
#pragma once

#include <optional>

#include "sensors/camera/camera_config.h"
#include "sensors/render/renderer.h"

namespace vsslam {

class CameraOptics {
 public:
  /// Throws InputError if the distortion cannot be inverted somewhere in the image.
  explicit CameraOptics(const CameraConfig& config);

  /// Image point of a point or direction; nothing behind the camera has one.
  std::optional<Vec2> project(const Vec3& p_camera) const;
  /// Image point of one direction minus that of another, both with z = 1 and given by their x and y.
  Vec2 difference(const Vec2& to, const Vec2& from) const {
    if (distorted_) return focal_px_.cwiseProduct(distort(to) - distort(from));
    return focal_px_.cwiseProduct(to - from);
  }
  /// Unit ray through an image point; projects back to within 1e-9 px.
  Vec3 ray(const Vec2& pixel) const;
  /// Rays through all pixels, each `offset_px` beside its centre.
  ViewRays rays(const Vec2& offset_px = Vec2::Zero()) const;
  /// A small view of the whole image, corner to corner.
  ViewRays coarse_rays(int width, int height) const;

 private:
  Vec2 distort(const Vec2& ideal) const;
  Vec2 undistort(const Vec2& distorted) const;
  Eigen::Matrix2d distortion_jacobian(const Vec2& ideal) const;
  ViewRays grid(int width, int height, const Vec2& first_px, const Vec2& step_px) const;

  int width_px_, height_px_;
  Vec2 focal_px_, centre_px_;
  double k1_, k2_, p1_, p2_;
  bool distorted_;
};

}  // namespace vsslam

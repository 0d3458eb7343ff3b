// Points as a camera would see them, and the depth of the surface along a ray between them.
#pragma once

#include <optional>
#include <vector>

#include "core/config.h"

namespace vsslam {

struct DepthViewConfig {
  double bin_deg = 0.4;     ///< of all points in one bin the nearest hides the others
  double search_deg = 2.5;  ///< a surface is supported by points within this angle of the ray: more than the
                            ///< distance between scan lines
  double max_spread_m = 2.0;    ///< in depth, between the three points that support it
  double min_graze_deg = 5.0;   ///< between ray and surface
  double surface_m = 0.1;       ///< points are on a surface up to this distance,
  double surface_share = 0.01;  ///< and this share of the range more
  void fields(Fields& f);
};

/// An image of points about the camera's axis, in bins of x / z and y / z. Camera frame: x right, y down, z
/// forward.
class DepthView {
 public:
  /// The view reaches from -extent to +extent in x / z and y / z.
  DepthView(const DepthViewConfig& config, const Eigen::Vector2f& extent);

  void add(const Eigen::Vector3f& point_camera) {
    const float z = point_camera.z();
    if (!(z > kNearest)) return;
    const float column = (point_camera.x() / z + extent_.x()) * bins_per_tangent_;
    const float row = (point_camera.y() / z + extent_.y()) * bins_per_tangent_;
    if (!(column >= 0 && row >= 0 && column < columns_ && row < rows_)) return;
    Eigen::Vector3f& nearest =
        bins_[static_cast<size_t>(static_cast<int>(row) * stride_ + static_cast<int>(column))];
    if (z < nearest.z()) nearest = point_camera;
  }

  /// Depth along z where the ray (x / z, y / z) meets the nearest surface around it: the plane through the three
  /// nearest points that enclose the ray. Empty if there are none, if they disagree, if other points beside the
  /// ray are off the plane, or if it is seen too grazingly.
  std::optional<double> depth_m(const Eigen::Vector2f& ray_camera) const;

 private:
  static constexpr float kNearest = 0.1f;  // m
  struct Neighbour;
  struct Surface;
  std::vector<Neighbour> neighbours(const Eigen::Vector2f& ray) const;
  bool surrounds(const std::vector<Neighbour>& points) const;
  std::vector<Neighbour> points_before(const Surface& surface, const std::vector<Neighbour>& points) const;
  bool supports(const std::vector<Neighbour>& points, const Surface& surface,
                const Eigen::Vector3f& ray) const;
  float tolerance_m(const Eigen::Vector3f& point) const;

  DepthViewConfig config_;
  Eigen::Vector2f extent_;
  float bins_per_tangent_, columns_, rows_;
  int stride_;
  std::vector<Eigen::Vector3f> bins_;  // the nearest point of each; z infinite: none
};

}  // namespace vsslam

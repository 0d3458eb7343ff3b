// A drivable path in the plane: smooth, sampled evenly, with a speed for every place.
#pragma once

#include <vector>

#include "core/se3.h"

namespace vsslam {

using Vec2 = Eigen::Vector2d;

/// Position and heading in the world's plane.
struct PlanarPose {
  Vec2 position_m = Vec2::Zero();
  double yaw_rad = 0;
};
PlanarPose planar(const SE3& T_world_base);

/// The nearest angle to zero: in [-pi, pi].
double wrap_angle(double rad);

/// What limits the speed along a path.
struct SpeedLimits {
  double speed_mps = 1.0;
  double yaw_rate_radps = 0.5;
  double accel_mps2 = 0.8;  ///< along the path
};

class Path {
 public:
  static constexpr double kSpacing_m = 0.05;  ///< of samples, as near as the length allows

  struct Place {
    Vec2 position_m = Vec2::Zero();
    double heading_rad = 0;      ///< not wrapped: continuous along the path
    double curvature_radpm = 0;  ///< positive: to the left
    double speed_mps = 0;
  };

  /// Samples the corners' polyline, rounds its corners (a right angle by 0.08 m) and shifts it by
  /// `offset_left_m` (one per sample of resample(corners), positive to the left).
  Path(const std::vector<Vec2>& samples, const std::vector<double>& offset_left_m, const SpeedLimits& limits);

  double length_m() const { return spacing_m_ * static_cast<double>(places_.size() - 1); }
  /// Interpolated; `s_m` is clamped to the path.
  Place at(double s_m) const;
  PlanarPose begin() const { return pose_of(places_.front()); }
  PlanarPose end() const { return pose_of(places_.back()); }
  /// Arc length of the point nearest to `position_m` between `from_m` and `to_m`.
  double nearest(const Vec2& position_m, double from_m, double to_m) const;
  /// Time to drive it from rest to rest.
  double duration_s() const;

 private:
  static PlanarPose pose_of(const Place& place) { return {place.position_m, wrap_angle(place.heading_rad)}; }
  void measure_directions();
  void limit_speed(const SpeedLimits& limits);

  std::vector<Place> places_;
  double spacing_m_ = kSpacing_m;
};

/// Points every Path::kSpacing_m (about) along a polyline, its ends included.
std::vector<Vec2> resample(const std::vector<Vec2>& corners);
double polyline_length_m(const std::vector<Vec2>& corners);

}  // namespace vsslam

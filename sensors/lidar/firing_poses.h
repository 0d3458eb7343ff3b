// Where the LiDAR is at each firing: the truth over a fraction of a millisecond, as a polynomial.
#pragma once

#include <array>

#include "core/se3.h"
#include "core/time.h"
#include "sim/trajectory.h"

namespace vsslam {

/// T_world_lidar over [begin, end], quadratic in s in [-1, 1]:
///   R(s) = R0 + s R1 + s^2 R2,  p(s) = p0 + s p1 + s^2 p2.
/// Error over 0.9 ms: position 6e-12 s^3 times the jerk; rotation the same with angular jerk, plus the third
/// power of the angle turned in half the span: below 1e-8 rad up to 4 rad/s, so below 1e-6 m at 100 m.
struct FiringPoses {
  std::array<Mat3, 3> R_world_lidar;
  std::array<Vec3, 3> p_world_lidar;
  double mid_ns = 0, half_ns = 1;  ///< s = (t - mid) / half, t in ns after `begin`

  static FiringPoses fit(const Trajectory& trajectory, const SE3& T_base_lidar, Time begin, Time end);
  static FiringPoses fixed(const SE3& T_world_lidar);
};

}  // namespace vsslam

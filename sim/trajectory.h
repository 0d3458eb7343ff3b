// The truth: one continuous trajectory through the states of the dynamics. Every sensor is sampled from it.
#pragma once

#include <deque>

#include "core/se3.h"
#include "core/time.h"

namespace vsslam {

/// Motion of the base frame at one instant.
struct Kinematics {
  SE3 T_world_base;
  Vec3 v_world = Vec3::Zero();          ///< velocity of base in world, m/s
  Vec3 a_world = Vec3::Zero();          ///< acceleration of base in world, m/s^2 (gravity not included)
  Vec3 omega_base = Vec3::Zero();       ///< angular velocity of base in world, expressed in base, rad/s
  Vec3 alpha_base = Vec3::Zero();       ///< its derivative, expressed in base, rad/s^2
};

/// C2 spline in SE(3): a uniform cumulative cubic B-spline on SO(3) x R^3 (Sommer et al., CVPR 2020) whose
/// control poses are the states of the dynamics every `knot_interval`. Streaming: old knots can be dropped.
class Trajectory {
 public:
  explicit Trajectory(Duration knot_interval = Duration{10'000'000});

  /// Appends the pose at begin_of_time + n * knot_interval. The first push fixes the start.
  void push(Time stamp, const SE3& T_world_base);
  /// Knots that only times before `stamp` need are dropped.
  void forget_before(Time stamp);

  /// Poses are defined for begin() <= t <= end(); end() lags the last push by one knot interval.
  Time begin() const;
  Time end() const;
  Duration knot_interval() const { return interval_; }

  SE3 pose(Time stamp) const;
  Kinematics at(Time stamp) const;

 private:
  Duration interval_;
  int64_t first_knot_ns_ = 0;
  std::deque<SE3> knots_;  // T_world_base
};

}  // namespace vsslam

// The truth: one continuous trajectory through the states of the dynamics. Every sensor is sampled from it.
#pragma once

#include <array>
#include <deque>

#include "core/se3.h"
#include "core/time.h"

namespace vsslam {

/// Motion of the base frame at one instant.
struct Kinematics {
  SE3 T_world_base;
  Vec3 v_world = Vec3::Zero();     ///< velocity of base in world, m/s
  Vec3 a_world = Vec3::Zero();     ///< acceleration of base in world, m/s^2 (gravity not included)
  Vec3 omega_base = Vec3::Zero();  ///< angular velocity of base in world, expressed in base, rad/s
  Vec3 alpha_base = Vec3::Zero();  ///< its derivative, expressed in base, rad/s^2
};

/// C2 spline in SE(3): a uniform cumulative cubic B-spline on SO(3) x R^3 (Sommer et al., CVPR 2020) whose
/// control poses are the states of the dynamics every `knot_interval`. It passes beside a control pose by a
/// sixth of the second difference there: 0.05 mm at 3 m/s^2 and 10 ms. Streaming: old knots can be dropped.
class Trajectory {
 public:
  explicit Trajectory(Duration knot_interval = Duration{10'000'000});

  /// Appends the pose one knot interval after the last one. The first push fixes the start.
  void push(Time stamp, const SE3& T_world_base);
  /// Knots that only times before `stamp` need are dropped.
  void forget_before(Time stamp);

  /// Poses are defined for begin() <= t <= end(): from one knot interval after the first push until one
  /// before the last. Four pushes make the first segment; before that begin() > end().
  Time begin() const;
  Time end() const;
  Duration knot_interval() const { return interval_; }
  size_t knot_count() const { return knots_.size(); }

  /// Aborts outside of begin() .. end(): whoever asks must know what is there.
  SE3 pose(Time stamp) const;
  Kinematics at(Time stamp) const;

 private:
  struct Knot {
    SE3 T_world_base;
    Vec3 rotation_step = Vec3::Zero();     // Log(R_before^T R), rad
    Vec3 translation_step = Vec3::Zero();  // p - p_before, m
  };
  // The four knots around a stamp, and how far the stamp is between the middle two.
  struct Segment {
    std::array<const Knot*, 4> knots;
    double u = 0;  // 0 .. 1
  };
  Segment segment(Time stamp) const;

  Duration interval_;
  int64_t first_knot_ns_ = 0;
  std::deque<Knot> knots_;
};

}  // namespace vsslam

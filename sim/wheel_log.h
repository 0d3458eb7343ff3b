// What the wheels did, step by step of the dynamics, and where a robot that trusts its wheels believes to be.
#pragma once

#include <deque>

#include "core/time.h"
#include "sim/dynamics.h"
#include "sim/path.h"
#include "sim/wheel_state.h"

namespace vsslam {

class WheelLog {
 public:
  static constexpr int64_t kKept_ns = 5'000'000'000;

  explicit WheelLog(const ScoutConfig& scout) : scout_(scout) {}

  /// One entry per step of the dynamics.
  void push(Time stamp, const RobotState& state);
  /// Keeps the last kKept_ns nevertheless, for moved_since.
  void forget_before(Time stamp);
  /// A copy that begins at the entry before `stamp`, or at the first one kept.
  WheelLog since(Time stamp) const;
  /// Between the first entry kept and the last; aborts outside.
  WheelState at(Time stamp) const;
  /// Pose now in the base frame of `since`, dead-reckoned from the wheels' rotation. Entries that were dropped count
  /// as no motion.
  PlanarPose moved_since(Time since) const;

 private:
  struct Entry {
    WheelState wheels;
    PlanarPose odom;  // dead-reckoned from the first entry on
  };

  const ScoutConfig scout_;
  int64_t first_ns_ = 0;
  std::deque<Entry> entries_;
};

/// b in the frame of a.
PlanarPose relative(const PlanarPose& a, const PlanarPose& b);
/// a, then b in the frame of a.
PlanarPose compose(const PlanarPose& a, const PlanarPose& b);

}  // namespace vsslam

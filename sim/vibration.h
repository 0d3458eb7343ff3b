// Vibration of the chassis on its tyres, added on purpose: a profile along the way that the wheels have rolled, so it
// stands still with the robot, shakes faster and harder at speed, and the truth knows it exactly.
#pragma once

#include <array>

#include "sim/dynamics.h"

namespace vsslam {

class Vibration {
 public:
  explicit Vibration(const ScoutConfig& scout);

  void roll_on(const RobotState& state, double dt_s);
  /// The vibrating base frame in the one of the dynamics. Identity where no vibration is asked for.
  SE3 T_still_base() const;

 private:
  struct Wave {
    double amplitude = 0, k_radpm = 0, phase_rad = 0;
  };
  using Waves = std::array<Wave, 6>;
  Waves waves(uint64_t axis, double rms, int derivative) const;
  double sum(const Waves& waves) const;

  const ScoutConfig scout_;
  Waves z_m_, roll_rad_, pitch_rad_;
  double rolled_m_ = 0;
};

}  // namespace vsslam

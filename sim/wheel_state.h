// True rotation of the wheels at one instant.
#pragma once

namespace vsslam {

/// Sampled with the dynamics and interpolated.
struct WheelState {
  double left_rad = 0, right_rad = 0;  ///< mean of front and rear
  double left_radps = 0, right_radps = 0;
  double slip_left_mps = 0, slip_right_mps = 0;  ///< wheel surface speed minus ground speed along the wheel
};

}  // namespace vsslam

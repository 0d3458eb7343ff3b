// Wheel encoders: rotation of the wheels, not of the robot over ground, so that slip shows as it does in
// life.
#pragma once

#include <cstdint>

#include "core/config.h"
#include "sensors/measurement/samples.h"
#include "sim/wheel_state.h"

namespace vsslam {

struct WheelEncoderConfig {
  double rate_hz = 50;
  double ticks_per_turn = 4096;  ///< 0: not quantised
  double radius_sigma =
      0.005;  ///< of each side's tyres about the nominal radius, relative; drawn once per seed
  void fields(Fields& f);
};

class WheelEncoder {
 public:
  WheelEncoder(const WheelEncoderConfig& config, uint64_t seed);
  Time stamp(int64_t index) const;  ///< of sample 0, 1, 2, ...
  int64_t first_index(Time at_or_after) const;
  WheelMeasurement measure(int64_t index, const WheelState& state) const;

 private:
  WheelEncoderConfig config_;
  double left_scale_, right_scale_;  // nominal over actual tyre radius
};

}  // namespace vsslam

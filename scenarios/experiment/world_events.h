// What changes during a run, by the simulated clock.
#pragma once

#include <vector>

#include "core/config.h"
#include "core/time.h"
#include "sensors/measurement/sensor_events.h"

namespace vsslam {

/// Wheels that lose their grip: oil, wet leaves, a threshold.
struct WheelSlipEvent {
  double at_s = 0, duration_s = 1;
  double left_friction = 0.1, right_friction = 0.1;  ///< share of the normal friction
  void fields(Fields& f);
};

/// The `events` section of a scenario.
struct EventsConfig {
  SensorEvents sensors;  ///< its keys stand in `events` itself
  std::vector<WheelSlipEvent> wheel_slip;
  void fields(Fields& f);
};

}  // namespace vsslam

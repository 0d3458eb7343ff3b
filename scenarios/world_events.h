// What changes during a run, by the simulated clock.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "core/time.h"
#include "sensors/sensor_events.h"

namespace vsslam {

/// Wheels that lose their grip: oil, wet leaves, a threshold.
struct WheelSlipEvent {
  double at_s = 0, duration_s = 1;
  double left_friction = 0.1, right_friction = 0.1;  ///< share of the normal friction
  void fields(Fields& f);
};

/// Lamps that go off, on, or are dimmed. For cameras; a LiDAR does not notice.
struct LightEvent {
  double at_s = 0;
  std::string group;  ///< of lights; empty: all
  double level = 0;   ///< share of the intensity in the world file
  void fields(Fields& f);
};

/// The `events` section of a scenario.
struct EventsConfig {
  SensorEvents sensors;  ///< its keys stand in `events` itself
  std::vector<WheelSlipEvent> wheel_slip;
  std::vector<LightEvent> lights;
  void fields(Fields& f);
};

}  // namespace vsslam

#include "scenarios/experiment/world_events.h"

namespace vsslam {

void WheelSlipEvent::fields(Fields& f) {
  f("at_s", at_s, non_negative());
  f("duration_s", duration_s, positive());
  f("left_friction", left_friction, between(0, 10));
  f("right_friction", right_friction, between(0, 10));
}

void EventsConfig::fields(Fields& f) {
  sensors.fields(f);
  f("wheel_slip", wheel_slip);
}

}  // namespace vsslam

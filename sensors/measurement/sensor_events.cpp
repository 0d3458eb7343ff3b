#include "sensors/measurement/sensor_events.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vsslam {

void EventSpan::fields(Fields& f) {
  f("from_s", from_s, non_negative());
  f("to_s", to_s, non_negative());
  f.check(to_s >= from_s, "to_s", "from_s or later");
}

void LostPackets::fields(Fields& f) {
  EventSpan::fields(f);
  f("probability", probability, between(0, 1));
}

void BlockedSector::fields(Fields& f) {
  EventSpan::fields(f);
  f("from_deg", from_deg, between(-360, 360));
  f("to_deg", to_deg, between(-360, 360));
  f.check(to_deg >= from_deg, "to_deg", "from_deg or more");
}

bool BlockedSector::covers(double azimuth_rad) const {
  const double turns = (azimuth_rad * 180 / std::numbers::pi - from_deg) / 360;
  return 360 * (turns - std::floor(turns)) <= to_deg - from_deg;
}

void CoveredLens::fields(Fields& f) {
  EventSpan::fields(f);
  f("transmission", transmission, between(0, 1));
}

void ImuSpikes::fields(Fields& f) {
  EventSpan::fields(f);
  f("probability", probability, between(0, 1));
  f("gyro_radps", gyro_radps, non_negative());
  f("accel_mps2", accel_mps2, non_negative());
}

void ClockError::fields(Fields& f) {
  EventSpan::fields(f);
  f.choice("sensor", sensor,
           {{"lidar", SensorKind::lidar},
            {"imu", SensorKind::imu},
            {"wheels", SensorKind::wheels},
            {"camera", SensorKind::camera}});
  f("offset_s", offset_s, between(-10, 10));
  f("jitter_s", jitter_s, between(0, 1));
}

void ObjectEvent::fields(Fields& f) {
  f("object", object);
  f("at_s", at_s, non_negative());
  f.choice("action", action,
           {{"appear", Action::appear}, {"disappear", Action::disappear}, {"slide", Action::slide}});
  f("by_m", by_m);
  f("duration_s", duration_s, non_negative());
}

void LightEvent::fields(Fields& f) {
  f("at_s", at_s, non_negative());
  f("group", group);
  f("level", level, non_negative());
}

void SensorEvents::fields(Fields& f) {
  f("lidar_dropouts", lidar_dropouts);
  f("imu_dropouts", imu_dropouts);
  f("wheel_dropouts", wheel_dropouts);
  f("camera_dropouts", camera_dropouts);
  f("lidar_lost_packets", lidar_lost_packets);
  f("lidar_blocked_sectors", lidar_blocked_sectors);
  f("camera_covered", camera_covered);
  f("imu_spikes", imu_spikes);
  f("clocks", clocks);
  f("objects", objects);
  f("lights", lights);
}

bool any_lasts(const std::vector<SensorDropout>& spans, Time stamp) {
  return std::any_of(spans.begin(), spans.end(),
                     [&](const SensorDropout& span) { return span.contains(stamp); });
}

}  // namespace vsslam

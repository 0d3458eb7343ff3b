#include "sensors/measurement/faults.h"

#include <algorithm>

namespace vsslam {

Time ClockErrors::stamp(SensorKind sensor, Time now, double period_s) const {
  Time stamp = now;
  for (size_t i = 0; i < errors_.size(); ++i) {
    const ClockError& error = errors_[i];
    if (error.sensor != sensor || !error.contains(now)) continue;
    const double jitter_s = std::min(error.jitter_s, 0.49 * period_s) * (2 * jitter_.uniform(now, i) - 1);
    stamp = stamp + Duration::from_seconds(error.offset_s + jitter_s);
  }
  return stamp;
}

namespace {

Vec3 random_direction(const RandomStream& stream, uint64_t a, uint64_t b) {
  const Vec3 v(stream.normal(a, b), stream.normal(a, b + 1), stream.normal(a, b + 2));
  return v.normalized();
}

}  // namespace

void add_spikes(const std::vector<ImuSpikes>& events, const RandomStream& stream, int64_t sample_index,
                ImuMeasurement& measurement) {
  const auto counter = static_cast<uint64_t>(sample_index);
  for (size_t i = 0; i < events.size(); ++i) {
    const uint64_t lane = 8 * i;
    if (!events[i].contains(measurement.true_stamp)) continue;
    if (stream.uniform(counter, lane) >= events[i].probability) continue;
    measurement.sample.gyro_radps += events[i].gyro_radps * random_direction(stream, counter, lane + 1);
    measurement.sample.accel_mps2 += events[i].accel_mps2 * random_direction(stream, counter, lane + 4);
  }
}

}  // namespace vsslam

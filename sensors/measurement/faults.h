// Errors that events put on top of measurements: wrong stamps and single wild samples.
#pragma once

#include <vector>

#include "core/rng.h"
#include "sensors/measurement/samples.h"
#include "sensors/measurement/sensor_events.h"

namespace vsslam {

class ClockErrors {
 public:
  ClockErrors(std::vector<ClockError> errors, uint64_t seed)
      : errors_(std::move(errors)), jitter_(seed, "events.clocks") {}
  /// What the sensor's clock says at true time `now`; `period_s` bounds the jitter.
  Time stamp(SensorKind sensor, Time now, double period_s) const;

 private:
  std::vector<ClockError> errors_;
  RandomStream jitter_;
};

void add_spikes(const std::vector<ImuSpikes>& events, const RandomStream& stream, int64_t sample_index,
                ImuMeasurement& measurement);

}  // namespace vsslam

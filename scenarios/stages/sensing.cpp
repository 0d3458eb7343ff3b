#include "scenarios/stages/sensing.h"

#include <utility>

namespace vsslam {

Sensing::Sensing(const Scenario& scenario, const World& world, uint64_t seed, StageClock* clock)
    : clock_(clock),
      handed_(scenario.handed),
      disturber_(scenario.handed.scans, scenario.rig.sensors.lidar, seed),
      rig_(world, scenario.rig, scenario.events.sensors, seed, scenario.lighting),
      T_lidar_base_(scenario.rig.mounts.lidar.T_base_sensor().inverse()) {
  rig_.leave_out(
      {.scan = [handed = handed_](int64_t scan, Time stamp) { return !handed.hands_scan(scan, stamp); }});
}

Chunk Sensing::next(const Motion& motion) {
  Chunk chunk{.until = motion.until, .measurements = {}, .scans = {}};
  {
    StageTimer timer(clock_, "sense");
    rig_.advance(
        motion.until, motion.trajectory, [&](Time t) { return motion.wheels.at(t); },
        [&](Measurement&& m) { hand(std::move(m), chunk); });
  }
  add_truth(chunk);
  return chunk;
}

void Sensing::hand(Measurement&& measurement, Chunk& chunk) {
  const Time stamp = stamp_of(measurement);
  if (auto* lidar = std::get_if<LidarMeasurement>(&measurement)) {
    if (!handed_.hands_scan(delivered_scans_++, stamp)) return;
    disturber_.disturb(*lidar);
  } else if (!handed_.has_begun(stamp)) {
    return;
  }
  chunk.measurements.push_back(std::move(measurement));
}

void Sensing::add_truth(Chunk& chunk) const {
  StageTimer timer(clock_, "truth");
  for (const Measurement& measurement : chunk.measurements)
    if (const auto* lidar = std::get_if<LidarMeasurement>(&measurement))
      chunk.scans.push_back({lidar->T_world_lidar * T_lidar_base_, degeneracy_truth(*lidar)});
}

}  // namespace vsslam

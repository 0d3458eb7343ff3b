#include "scenarios/sensing.h"

#include <utility>

namespace vsslam {

Sensing::Sensing(const Scenario& scenario, const World& world, uint64_t seed, StageClock* clock)
    : clock_(clock),
      rig_(world, scenario.rig, scenario.events.sensors, seed, scenario.lighting),
      T_lidar_base_(scenario.rig.mounts.lidar.T_base_sensor().inverse()) {}

Chunk Sensing::next(const Motion& motion) {
  Chunk chunk{.until = motion.until, .measurements = {}, .scans = {}};
  {
    StageTimer timer(clock_, "sense");
    rig_.advance(
        motion.until, motion.trajectory, [&](Time t) { return motion.wheels.at(t); },
        [&](Measurement&& m) { chunk.measurements.push_back(std::move(m)); });
  }
  add_truth(chunk);
  return chunk;
}

void Sensing::add_truth(Chunk& chunk) const {
  StageTimer timer(clock_, "truth");
  for (const Measurement& measurement : chunk.measurements)
    if (const auto* lidar = std::get_if<LidarMeasurement>(&measurement))
      chunk.scans.push_back({lidar->T_world_lidar * T_lidar_base_, degeneracy_truth(*lidar)});
}

}  // namespace vsslam

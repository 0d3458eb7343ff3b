// The sensors' side of a run: measurements of one stretch of the robot's motion after the other, each with its
// truth.
#pragma once

#include <vector>

#include "core/stage_clock.h"
#include "scenarios/experiment/scenario.h"
#include "scenarios/oracles/degeneracy_truth.h"
#include "sensors/rig.h"
#include "sim/motion.h"

namespace vsslam {

/// Truth of one LiDAR scan, at its stamp.
struct ScanTruth {
  SE3 T_world_base;
  DegeneracyTruth degeneracy;
};

/// Everything whose acquisition ended in one stretch of time. From a recording it has no truth: `scans` is empty,
/// and of the measurements only the samples are filled.
struct Chunk {
  Time until;
  std::vector<Measurement> measurements;  ///< in order of the end of their acquisition
  std::vector<ScanTruth> scans;           ///< one per LidarMeasurement, same order
  bool has_truth() const { return !scans.empty(); }
};

/// Not thread-safe; one per seed. Its chunks hold what the estimator is handed.
class Sensing {
 public:
  Sensing(const Scenario& scenario, const World& world, uint64_t seed, StageClock* clock);

  /// Stretches follow one another without gaps.
  Chunk next(const Motion& motion);
  /// From when on the next motion must be known.
  Time needed_from() const { return rig_.needed_from(); }
  const Raycaster& raycaster() { return rig_.raycaster(); }

 private:
  void hand(Measurement&& measurement, Chunk& chunk);
  void add_truth(Chunk& chunk) const;

  StageClock* clock_;
  HandedConfig handed_;
  ScanDisturber disturber_;
  int64_t delivered_scans_ = 0;
  Rig rig_;
  SE3 T_lidar_base_;
};

}  // namespace vsslam

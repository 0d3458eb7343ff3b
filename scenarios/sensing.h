// The simulated side of a run: the robot drives, its sensors measure. Delivers measurements in chunks of
// simulated time, each with its truth.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/stage_clock.h"
#include "scenarios/oracles/degeneracy_truth.h"
#include "scenarios/scenario.h"
#include "sensors/rig.h"
#include "sim/simulation.h"

namespace vsslam {

/// Truth of one LiDAR scan, at its stamp.
struct ScanTruth {
  SE3 T_world_base;
  DegeneracyTruth degeneracy;
};

/// Everything whose acquisition ended in one stretch of simulated time.
struct Chunk {
  Time until;
  std::vector<Measurement> measurements;  ///< in order of the end of their acquisition
  std::vector<ScanTruth> scans;           ///< one per LidarMeasurement, same order
};

/// What the estimator believes, for a robot that drives on it.
struct Belief {
  Time available;  ///< end of the scan that it comes from
  Time stamp;
  SE3 T_world_base;
};

/// Not thread-safe; one per seed.
class Sensing {
 public:
  Sensing(const Scenario& scenario, const World& world, uint64_t seed, StageClock* clock);

  /// The next chunk, of 0.1 s. With a belief the robot steers by it from here on.
  Chunk next(const std::optional<Belief>& belief);
  Time until() const { return until_; }
  bool ended() const { return ended_; }

  double expected_duration_s() const;
  DriveOutcome outcome() const { return simulation_.outcome(); }
  std::string outcome_text() const { return simulation_.outcome_text(); }
  Simulation::Deviation spline_deviation() const { return simulation_.spline_deviation(); }
  const Raycaster& raycaster() { return rig_.raycaster(); }

 private:
  void place_objects();
  void add_truth(Chunk& chunk) const;

  const Scenario& scenario_;
  StageClock* clock_;
  Simulation simulation_;
  Rig rig_;
  SE3 T_lidar_base_;
  std::vector<std::optional<ObjectState>> placed_;  // of the rig's moving objects, as the dynamics have them
  Time until_{0};
  bool ended_ = false;
};

}  // namespace vsslam

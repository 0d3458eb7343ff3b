// The robot's side of a run: it drives by its script or by what it believes, and leaves the truth of its
// motion, stretch by stretch, to the sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/stage_clock.h"
#include "scenarios/experiment/scenario.h"
#include "scenarios/stages/belief.h"
#include "sensors/moving_objects.h"
#include "sim/simulation.h"

namespace vsslam {

/// Not thread-safe; one per seed.
class Driving {
 public:
  Driving(const Scenario& scenario, const World& world, StageClock* clock);

  /// The next 0.1 s. With a belief the robot steers by it from here on. The motion reaches back to `keep_from`,
  /// which must not go back in time from call to call.
  Motion next(const std::optional<Belief>& belief, Time keep_from);
  Time until() const { return until_; }
  bool ended() const { return ended_; }

  double expected_duration_s() const;
  DriveOutcome outcome() const { return simulation_.outcome(); }
  std::string outcome_text() const { return simulation_.outcome_text(); }

 private:
  const Scenario& scenario_;
  StageClock* clock_;
  Simulation simulation_;
  MovingObjects moving_;
  std::vector<ObjectState> placed_;  // of moving_, as the dynamics have them
  Time until_{0};
  bool ended_ = false;
};

}  // namespace vsslam

// One seed of a scenario as a pipeline: driving -> sensing -> odometry -> mapping, once per
// method -> result folder.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "scenarios/driving.h"
#include "scenarios/estimation.h"
#include "scenarios/pipeline.h"
#include "scenarios/results.h"
#include "scenarios/runner.h"
#include "scenarios/scenario_world.h"
#include "scenarios/sensing.h"
#include "scenarios/wall_clock.h"

namespace vsslam {

/// What all seeds of a run share.
struct RunContext {
  std::shared_ptr<ScenarioWorld> place;
  RunOptions options;
  // Called under the schedule's lock.
  std::function<void(FinishedRun)> on_finished;
  std::function<void(double s, int64_t scans)>
      on_progress;  ///< simulated time and scans estimated since the last call
  std::function<void(double expected_s)> on_expected;  ///< simulated, of one run
  /// What became of a run that threw; the others go on. Empty: an exception ends everything. Lack of memory or
  /// disk always does.
  std::function<void(Method, uint64_t seed, const std::string& why)> on_failed;
};

class SeedRun final : public Pipeline {
 public:
  SeedRun(RunContext context, const std::vector<Method>& methods, uint64_t seed);

  Step claim() override;
  bool finished() const override;

 private:
  // One method. `busy` while a step of it runs; the other members are then that step's alone, but for the queue.
  struct Lane {
    Method method;
    WallClock clock;
    std::unique_ptr<MappingRun> estimation;
    std::deque<std::shared_ptr<const OdometryChunk>> queue;
    std::deque<Belief> beliefs;  // closed loop: not yet old enough to steer, and the one that steers
    Time consumed{0};
    bool busy = false, ended = false;  // ended: written or failed
  };

  Step next_step();
  Step contained(Step step, Lane* lane);
  void fail(Lane& lane, const std::string& why);
  Step open();
  Step drive();
  Step sense();
  Step locate();
  Step map(Lane& lane);
  Step judge();
  Step write(Lane& lane);
  bool may_drive() const;
  bool may_sense() const;
  bool may_locate() const;
  bool all_located() const;
  Time belief_due() const;
  std::optional<Belief> belief();
  FinishedRun write_result(Lane& lane);

  const Scenario& scenario() const { return context_.place->scenario(); }

  RunContext context_;
  uint64_t seed_;
  WallClock driving_clock_, sensing_clock_, odometry_clock_;
  int64_t start_ns_ = 0;
  std::unique_ptr<Driving> driving_;
  std::unique_ptr<Sensing> sensing_;
  std::unique_ptr<OdometryRun> odometry_;
  std::deque<std::shared_ptr<const Motion>> motions_;  // driven, not yet sensed
  std::deque<std::shared_ptr<const Chunk>> chunks_;    // sensed, not yet located
  Time needed_from_{0};
  std::unique_ptr<SeedFacts> facts_;
  bool opening_ = false, driving_busy_ = false, sensing_busy_ = false, odometry_busy_ = false,
       judging_ = false;
  int running_ = 0;                    // steps
  std::optional<std::string> broken_;  // what the steps that all methods share threw
  std::vector<std::unique_ptr<Lane>> lanes_;
};

/// The pipelines of one seed: one for all methods, or in closed loop one for each.
void add_seed_runs(const RunContext& context, const std::vector<Method>& methods, uint64_t seed,
                   std::vector<std::unique_ptr<Pipeline>>& pipelines);

}  // namespace vsslam

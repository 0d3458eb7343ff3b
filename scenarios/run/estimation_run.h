// One run as a pipeline: measuring -> odometry -> mapping, once per method -> result folder.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/run/measurement_source.h"
#include "scenarios/run/runner.h"
#include "scenarios/stages/pipeline.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

/// What is told of a run. Called under the schedule's lock.
struct RunEvents {
  std::function<void(FinishedRun)> on_finished;
  std::function<void(double s, int64_t scans)>
      on_progress;  ///< measured time and scans estimated since the last call
  std::function<void(double expected_s)> on_expected;  ///< measured time, of one method
  /// What became of a method that threw; the others go on. Empty: an exception ends everything. Lack of memory or
  /// disk always does.
  std::function<void(Method, const std::string& why)> on_failed;
};

class EstimationRun final : public Pipeline, private Beliefs {
 public:
  EstimationRun(std::unique_ptr<MeasurementSource> source, const std::vector<Method>& methods,
                RunEvents events);

  Step claim() override;
  bool finished() const override;

 private:
  // One method. `busy` while a step of it runs; the other members are then that step's alone, but for the queue.
  struct Lane {
    Method method;
    WallClock clock;
    std::unique_ptr<MappingRun> estimation;
    std::deque<std::shared_ptr<const OdometryChunk>> queue;
    std::deque<Belief> beliefs;  // not yet old enough to steer, and the one that steers
    Time consumed{0};
    bool busy = false, ended = false;  // ended: written or failed
  };

  Step next_step();
  Step contained(Step step, Lane* lane);
  void fail(Lane& lane, const std::string& why);
  Step open();
  Step locate();
  Step map(Lane& lane);
  Step judge();
  Step write(Lane& lane);
  bool may_locate() const;
  bool all_located() const;
  bool known(Time due) const override;
  std::optional<Belief> newest(Time due) override;
  FinishedRun write_result(Lane& lane);

  std::unique_ptr<MeasurementSource> source_;
  RunEvents events_;
  WallClock odometry_clock_;
  int64_t start_ns_ = 0;
  std::unique_ptr<OdometryRun> odometry_;
  bool opened_ = false, opening_ = false, odometry_busy_ = false, judging_ = false, judged_ = false;
  int running_ = 0;                    // steps
  std::optional<std::string> broken_;  // what the steps that all methods share threw
  std::vector<std::unique_ptr<Lane>> lanes_;
};

}  // namespace vsslam

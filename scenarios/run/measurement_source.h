// Where the measurements of a run come from: a simulated drive, or a recording. One estimation_run.h serves both.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "scenarios/results/results.h"
#include "scenarios/stages/belief.h"
#include "scenarios/stages/estimation.h"
#include "scenarios/stages/pipeline.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

/// What the estimator believes, for a source that drives on it. Times are of the ends of scans.
class Beliefs {
 public:
  virtual ~Beliefs() = default;
  /// Whatever has been measured up to `due` has been estimated.
  virtual bool known(Time due) const = 0;
  /// The newest that was available at `due`; older ones are forgotten.
  virtual std::optional<Belief> newest(Time due) = 0;
};

/// Not thread-safe, but for what a step does while it works.
class MeasurementSource {
 public:
  virtual ~MeasurementSource() = default;

  /// What takes time before the first step. Called once, on some thread.
  virtual void open() = 0;
  /// Known once it is open, as are the following.
  virtual const EstimatorSetup& setup() const = 0;
  virtual double expected_duration_s() const = 0;
  virtual bool drives_on_beliefs() const { return false; }
  /// A step towards the next chunk that may start now, or an empty one. Called under the schedule's lock.
  virtual Step claim(Beliefs& beliefs) = 0;
  /// No step runs, and no chunk will come beside those in chunks().
  virtual bool ended() const = 0;
  /// Works out what the results of all methods share, on some thread, after the last chunk was located.
  virtual void judge(const OdometryRun& odometry) = 0;

  /// Everything that a result of this source holds. The estimation and this source must outlive it.
  virtual RunRecord record(const MappingRun& estimation) const = 0;
  virtual std::filesystem::path result_folder(Method method) const = 0;
  /// What the result depends on beside the settings saved with it.
  virtual std::string made_by() const = 0;
  virtual void add_times(WallClock& clock) const = 0;

  /// Measured, not yet located; in order. Whoever takes the first removes it when done with it.
  std::deque<std::shared_ptr<const Chunk>>& chunks() { return chunks_; }
  const std::deque<std::shared_ptr<const Chunk>>& chunks() const { return chunks_; }

 private:
  std::deque<std::shared_ptr<const Chunk>> chunks_;
};

}  // namespace vsslam

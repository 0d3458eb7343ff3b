// Runs a scenario or a recording: its methods and seeds, as pipelines over the cores, each result written as it is finished.
//
// Per seed the robot drives and its sensors measure once; the measurements go in chunks of simulated time to
// one estimator per method. In closed loop the robot drives on the estimate, so each method drives its own.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/experiment/scenario.h"
#include "scenarios/results/metrics.h"
#include "scenarios/run/progress.h"

namespace vsslam {

struct RunOptions {
  std::filesystem::path out = "out/runs";
  int threads = 1;
};

/// A result folder that has been written.
struct FinishedRun {
  Method method{};
  uint64_t seed = 0;  ///< of a simulated run
  std::filesystem::path folder{};
  Metrics metrics{};
  double real_time_factor = 0;
  bool as_expected()
      const;  ///< the drive ended well, the result is worth something, every expectation is met
};

class MeasurementSource;

class Runner {
 public:
  /// Throws InputError if the world, the methods or the drive are not possible.
  Runner(const Scenario& scenario, const RunOptions& options);
  /// A run of one source, for each of the methods.
  Runner(std::unique_ptr<MeasurementSource> source, const std::vector<Method>& methods,
         const RunOptions& options);
  ~Runner();

  /// Throws Interrupted, ResourceError or InputError; what was finished until then is in finished().
  void run(const std::atomic<bool>& stop, Progress& progress);
  /// In order of method, then seed.
  std::vector<FinishedRun> finished() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

// Runs what a suite lacks, over the cores. One rendering per scenario and seed feeds all methods that miss it;
// as many scenarios' worlds are in memory as there are threads, or fewer.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "scenarios/run/progress.h"
#include "scenarios/run/simulated_drive.h"
#include "scenarios/suite/suite_plan.h"

namespace vsslam {

/// A run that threw; it leaves no result.
struct SuiteFailure {
  size_t scenario = 0;  ///< index into SuitePlan::scenarios
  Method method{};
  uint64_t seed = 0;
  std::string why;
};

struct SuiteRunOptions {
  int threads = 1;
  bool fresh = false;  ///< make everything anew
};

class SuiteRunner {
 public:
  /// Results that are whole, made from the same resolved scenario and by this build, are kept.
  SuiteRunner(const SuitePlan& plan, const SuiteRunOptions& options);

  int kept() const { return kept_; }        ///< results that were there
  int missing() const { return missing_; }  ///< results to make
  int made() const { return made_; }        ///< of them, so far
  /// In order of scenario, method and seed.
  const std::vector<SuiteFailure>& failures() const { return failures_; }

  /// A run that fails does not stop the others. Throws Interrupted and ResourceError; what was finished stays.
  void run(const std::atomic<bool>& stop, Progress& progress);

 private:
  /// The methods that a seed of a scenario lacks.
  struct Job {
    size_t scenario;
    uint64_t seed;
    std::vector<Method> methods;
  };
  double expected_s() const;
  RunEvents events(const Job& job, ProgressState& state, Progress& progress);

  const SuitePlan& plan_;
  SuiteRunOptions options_;
  std::vector<Job> jobs_;
  std::vector<double> duration_s_;  // by scenario, 0: not known yet
  std::vector<int> runs_of_;        // by scenario: how many are missing
  int kept_ = 0, missing_ = 0, made_ = 0;
  std::vector<SuiteFailure> failures_;
};

}  // namespace vsslam

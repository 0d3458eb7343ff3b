// What a suite consists of once its scenarios are resolved, and which of it is already there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/experiment/scenario.h"
#include "scenarios/suite/suite.h"

namespace vsslam {

/// One run of a suite.
struct PlannedRun {
  size_t scenario = 0;  ///< index into SuitePlan::scenarios
  Method method{};
  uint64_t seed = 0;
  std::filesystem::path folder;
};

struct SuitePlan {
  Suite suite;
  std::filesystem::path folder;     ///< of the whole suite
  std::vector<Scenario> scenarios;  ///< with the suite's settings
  std::vector<Method> methods;

  /// In order of scenario, then method, then seed.
  std::vector<PlannedRun> runs() const;
  /// The text of scenario.yaml beside the result of a run.
  std::string resolved(const PlannedRun& run) const;
};

/// Results go to <out>/<suite>/<scenario>/<method>/seed_<n>. Overrides come after the suite's settings. Throws InputError.
SuitePlan plan_suite(const Suite& suite, const std::filesystem::path& out,
                     const std::vector<Override>& overrides = {});

/// What stands in the folder of a run.
enum class StoredRun {
  none,            ///< nothing, or not a whole result
  other_scenario,  ///< made from other settings
  other_build,     ///< made by another build, or from another world file
  same
};
StoredRun stored_run(const SuitePlan& plan, const PlannedRun& run);

}  // namespace vsslam

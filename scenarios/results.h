// Scores a finished run and writes its result folder.
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/estimation.h"
#include "scenarios/metrics.h"
#include "scenarios/oracles/map_error.h"
#include "scenarios/wall_clock.h"

namespace vsslam {

/// What the results of one seed share.
struct SeedFacts {
  LoopOracle oracle;
  int64_t aliases = 0;
  std::string camera_png;  ///< empty without a camera
};
/// `raycaster` must outlive them.
SeedFacts seed_facts(const Scenario& scenario, const World& world, const Raycaster& raycaster,
                     const OdometryRun& odometry);

/// One run, finished.
struct RunRecord {
  const Scenario& scenario;  ///< of the whole experiment; the saved one names this method and seed only
  const SeedFacts& facts;
  const SurfaceDistance& surface;
  const MappingRun& estimation;
  uint64_t seed = 0;
  double duration_s = 0;
  std::string failure{};  ///< why the drive ended early; empty: it did not
};

/// A record with its scores.
struct ScoredRun {
  Metrics metrics;
  LoopScore loops;
};
ScoredRun score_run(const RunRecord& record);

/// Every file of the result but timing.json and report.html.
void write_results(const std::filesystem::path& folder, const RunRecord& record, const ScoredRun& scored);

/// timing.json.
struct Timing {
  double wall_s = 0, real_time_factor = 0;
  std::string made_by{};  ///< fingerprint()
};
void write_timing(const std::filesystem::path& folder, const Timing& timing, const WallClock& clock);

/// What is saved beside the result of one method and seed.
Scenario scenario_of_run(Scenario scenario, Method method, uint64_t seed);

/// <out>/<scenario>/<method>/seed_<n>
std::filesystem::path result_path(const std::filesystem::path& out, const std::string& scenario,
                                  Method method, uint64_t seed);

}  // namespace vsslam

// Scores a finished run and writes its result folder.
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/estimation.h"
#include "scenarios/metrics.h"
#include "scenarios/oracles/map_error.h"
#include "scenarios/wall_clock.h"

namespace vsslam {

/// One run, finished: the world that it took place in, the sensing side and the estimating side.
struct RunRecord {
  const Scenario& scenario;  ///< of the whole experiment; the saved one names this method and seed only
  const World& world;
  const Raycaster& raycaster;
  const SurfaceDistance& surface;
  const MappingRun& estimation;
  const ContactSheet& pictures;
  uint64_t seed = 0;
  double duration_s = 0;
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
};
void write_timing(const std::filesystem::path& folder, const Timing& timing, const WallClock& clock);

/// <out>/<scenario>/<method>/seed_<n>
std::filesystem::path result_path(const std::filesystem::path& out, const std::string& scenario,
                                  Method method, uint64_t seed);

}  // namespace vsslam

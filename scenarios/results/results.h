// Scores a finished run and writes its result folder.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/health/health.h"
#include "scenarios/oracles/map_error.h"
#include "scenarios/results/metrics.h"
#include "scenarios/stages/estimation.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

/// A file that is saved with a result as it is.
struct SavedText {
  std::string name, text;
};

/// One run, finished: what there is to score and to write of it.
struct RunRecord {
  std::string name;                ///< of the scenario or the recording
  std::optional<uint64_t> seed{};  ///< of a simulated run
  const EstimatorSetup& setup;
  const MappingRun& estimation;
  Truth truth = Truth::none;
  std::span<const StampedPose> truth_world_base{};  ///< at any stamps; empty without truth
  const SurfaceDistance* surface = nullptr;         ///< with truth of the world
  LoopScore loops{};                                ///< one judgement per LoopRecord of the estimation
  int64_t aliases = 0;
  MetricBounds bounds{};
  std::string camera_png{};  ///< empty without a camera
  std::vector<SavedText> saved{};
  Duration stamp_offset{};  ///< added to the samples' stamps where stamps are written
  double duration_s = 0;
  std::string failure{};  ///< why the run ended early; empty: it did not
  SourceHealth source_health{};
  Health health{};  ///< of the sensors and the odometry, which all methods share
};

Metrics score_run(const RunRecord& record);

/// Every file of the result but timing.json and report.html.
void write_results(const std::filesystem::path& folder, const RunRecord& record, const Metrics& metrics);

/// timing.json.
struct Timing {
  double wall_s = 0, real_time_factor = 0;
  std::string made_by{};  ///< fingerprint()
};
void write_timing(const std::filesystem::path& folder, const Timing& timing, const WallClock& clock);

}  // namespace vsslam

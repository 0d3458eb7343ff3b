// Makes the content of a dataset: the robot drives, its sensors measure, every sink takes what it wants. No estimation.
// The three steps are a pipeline over the cores; a few tenths of a simulated second are in memory at a time.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"
#include "scenarios/experiment/scenario_world.h"
#include "scenarios/run/progress.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

struct ExportOutcome {
  DatasetCounts counts;
  std::string failure;  ///< why the drive ended early; empty: it did not
  double wall_s = 0;
  double real_time_factor() const { return wall_s > 0 ? counts.duration_s / wall_s : 0; }
  WallClock clock;  ///< times of the steps
};

/// Fills the sinks and finishes them. The scenario's first seed counts. Bytes do not depend on `threads`.
/// Throws Interrupted, ResourceError or InputError; then nothing has been finished.
ExportOutcome run_export(ScenarioWorld& place, const std::vector<std::unique_ptr<DatasetSink>>& sinks,
                         int threads, const std::atomic<bool>& stop, Progress& progress);

}  // namespace vsslam

// What a run tells at its end.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenarios/cli/cli.h"
#include "scenarios/run/runner.h"

namespace vsslam {

/// A table of the main figures, what is doubtful of the sensors, the expectations with PASS or FAIL, and where the reports are.
std::string summary_text(std::span<const FinishedRun> runs);

/// What was finished before something went wrong.
std::string finished_text(std::span<const FinishedRun> runs);

/// A JSON list of the metrics.json that were written.
std::string summary_json(std::span<const FinishedRun> runs);

/// Runs, with progress meanwhile, and prints the summary, or what was finished before something went wrong.
std::vector<FinishedRun> run_and_summarize(Runner& runner, std::unique_ptr<Progress> progress,
                                           const Console& console);

}  // namespace vsslam

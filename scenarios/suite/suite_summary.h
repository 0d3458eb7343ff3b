// What a suite tells at its end.
#pragma once

#include <string>

#include "scenarios/suite/suite_figures.h"

namespace vsslam {

/// The table of errors, where the method in focus is behind, expectations with PASS or FAIL, failed runs, files.
std::string suite_text(const SuiteFigures& figures);

/// {suite, folder, runs, present, as_expected, failures: [{scenario, method, seed, why}], expectations:
/// [{method, metric, value, bound, pass}], error: [{scenario, method, metric, mean, deviation, seeds, reference}]}
std::string suite_json(const SuiteFigures& figures);

}  // namespace vsslam

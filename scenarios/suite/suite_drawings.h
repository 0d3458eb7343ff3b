// What the page of a suite draws, as JSON with series as base64 typed arrays.
#pragma once

#include <string>

#include "scenarios/suite/suite_figures.h"
#include "scenarios/suite/suite_offsets.h"

namespace vsslam {

/// {methods, focus, scenarios: [{name, seed, truth, estimates, map, keys, stored, example}], bars, offsets}; thinned so that
/// ten scenarios with six methods stay below 3 MB. Contains no "<". Throws InputError for a broken result.
std::string suite_drawings(const SuiteFigures& figures, const std::vector<MethodOffsets>& offsets);

}  // namespace vsslam

// What the page's script draws: one JSON text with series as base64 typed arrays.
#pragma once

#include <span>
#include <string>

#include "scenarios/report/stored_result.h"

namespace vsslam {

/// Series are thinned so that the whole page stays below 3 MB for any number of results. Contains no "<", so
/// it may stand inside a script element. Throws InputError for values that do not belong together.
std::string page_data(std::span<const StoredResult> results);

}  // namespace vsslam

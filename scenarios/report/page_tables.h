// The parts of the page that need no script: headline figures, expectations, loops, timing.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scenarios/report/result_folder.h"

namespace vsslam {

std::string escape_html(std::string_view text);

/// Tiles with the headline figures of a single result.
std::string headline_html(const ResultFolder& result);
/// Every figure of metrics.json in groups, one column per result; the best of several is marked.
std::string metrics_html(std::span<const ResultFolder> results);
/// Empty if no result has expectations.
std::string expectations_html(std::span<const ResultFolder> results);
/// Loop candidates of each result that has any; empty otherwise.
std::string loops_html(std::span<const ResultFolder> results);
/// Empty if no result has a timing.json.
std::string timing_html(std::span<const ResultFolder> results);

}  // namespace vsslam

// The parts of the page that need no script: headline figures, expectations, loops, timing.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scenarios/report/stored_result.h"

namespace vsslam {

std::string escape_html(std::string_view text);

/// One line: all expectations met, or how many were not. Empty without expectations.
std::string verdict_html(std::span<const StoredResult> results);
/// Tiles with the headline figures of a single result.
std::string headline_html(const StoredResult& result);
/// Every figure of metrics.json in groups, one column per result; the best of several is marked.
std::string metrics_html(std::span<const StoredResult> results);
/// Empty if no result has expectations.
std::string expectations_html(std::span<const StoredResult> results);
/// Loop candidates of each result that has any; empty otherwise.
std::string loops_html(std::span<const StoredResult> results);
/// Empty if no result has a timing.json.
std::string timing_html(std::span<const StoredResult> results);

}  // namespace vsslam

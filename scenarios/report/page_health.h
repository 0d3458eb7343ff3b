// The page's panel of how the sensors fared.
#pragma once

#include <span>
#include <string>

#include "scenarios/report/stored_result.h"

namespace vsslam {

/// Whether its errors are in part those of a prior alone: they are shown with a mark and are never the best.
bool lidar_blind(const StoredResult& result);
/// A chip for the head of the page: worthless, warnings, or all well. Empty for results that say nothing of health.
std::string health_verdict_html(std::span<const StoredResult> results);
/// Warnings, what was set right, lost spans and a table of the sensors of each result; empty likewise.
std::string health_html(std::span<const StoredResult> results);

}  // namespace vsslam

// The CSV files of a result, by the columns of results_columns.h.
#pragma once

#include <span>
#include <string>

#include "scenarios/estimation.h"

namespace vsslam {

std::string scans_csv(const Estimation& estimation, const LoopScore& loops);
std::string loops_csv(std::span<const LoopRecord> records, const LoopScore& loops);
std::string descriptors_csv(const Slam& slam);

}  // namespace vsslam

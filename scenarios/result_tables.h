// The CSV files of a result, by the columns of results_columns.h.
#pragma once

#include <span>
#include <string>

#include "scenarios/estimation.h"

namespace vsslam {

std::string scans_csv(const MappingRun& estimation, const LoopScore& loops);
std::string loops_csv(std::span<const LoopRecord> records, const LoopScore& loops);
std::string descriptors_csv(const Mapping& mapping);

}  // namespace vsslam

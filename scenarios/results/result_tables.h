// The CSV files of a result, by the columns of results_columns.h.
#pragma once

#include <string>

#include "scenarios/results/results.h"

namespace vsslam {

std::string scans_csv(const RunRecord& record);
std::string loops_csv(const RunRecord& record);
std::string descriptors_csv(const RunRecord& record);

}  // namespace vsslam

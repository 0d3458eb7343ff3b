// README.md of a dataset: what it is, what is in it, in which frames and units, and how to play it.
#pragma once

#include <string>

#include "scenarios/datasets/export/dataset_export.h"

namespace vsslam {

std::string dataset_readme(const ExportPlan& plan, const DatasetCounts& counts);

}  // namespace vsslam

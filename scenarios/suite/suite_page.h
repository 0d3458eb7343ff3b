// report.html of a suite: one self-contained page made from the files of its results.
#pragma once

#include <string>

#include "scenarios/suite/suite_figures.h"
#include "scenarios/suite/suite_offsets.h"

namespace vsslam {

/// Tables, trajectories of all methods over the truth, scene recognition and stored descriptors along the path, key
/// descriptors with their clouds, memory, loops, recall over lateral offset, timing. Drawings are of the first seed that has a
/// result. Everything but the part between `<!-- timing begin -->` and `<!-- timing end -->` is the same, byte for
/// byte, for the same results.
std::string suite_page(const SuiteFigures& figures, const std::vector<MethodOffsets>& offsets);

}  // namespace vsslam

// Recall of loops over the lateral offset at which places were passed again.
#pragma once

#include <string>
#include <vector>

#include "scenarios/suite/suite_figures.h"

namespace vsslam {

/// Revisits (by the truth, scans.csv) whose lateral offset lies in [low_m, high_m), over all runs of a method. The offset of a
/// revisit is how far the true position of its key scan lies to the side of the nearest older key scan that it shows again:
/// |y| in the true base frame of that one.
struct OffsetBin {
  double low_m = 0, high_m = 0;
  int revisits = 0;
  int closed = 0;  ///< with a true loop edge within 4 m of them
};

struct MethodOffsets {
  Method method;
  std::vector<OffsetBin> bins;
};

/// One entry per method that has candidates: 0 to 0.5 m, then 1 m wide around 1, 2 and 3 m, and 3.5 m to 4 m. Throws
/// InputError for a broken result.
std::vector<MethodOffsets> recall_over_offset(const SuiteFigures& figures);

/// offsets.csv
std::string offsets_csv(const std::vector<MethodOffsets>& offsets);

}  // namespace vsslam

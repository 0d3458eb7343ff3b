// Point clouds of the estimator.
#pragma once

#include <vector>

#include "core/se3.h"

namespace vsslam {

/// Points in the frame that the variable's name ends with, e.g. cloud_lidar. m.
using Cloud = std::vector<Eigen::Vector3f>;

}  // namespace vsslam

// What the estimator believes, for a robot that drives on it.
#pragma once

#include "core/se3.h"
#include "core/time.h"

namespace vsslam {

struct Belief {
  Time available;  ///< end of the scan that it comes from
  Time stamp;
  SE3 T_world_base;
};

}  // namespace vsslam

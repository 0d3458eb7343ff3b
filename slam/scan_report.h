// What became of one scan.
#pragma once

#include <optional>

#include "core/se3.h"
#include "core/time.h"
#include "slam/lidar/information.h"
#include "slam/loop/memory_decision.h"

namespace vsslam {

struct ScanReport {
  Time stamp;
  int64_t scan = 0;         ///< 0, 1, 2, ... in order of arrival
  int key = -1;             ///< key scan id, -1: not a key scan
  SE3 T_map_base;           ///< belief right after this scan
  SE3 T_odom_base;          ///< odometry alone
  Information information;  ///< blocks of the point-to-plane problem at its last iteration
  int correspondences = 0;
  int iterations = 0;
  bool converged = false;
  int degenerate_directions = 0;         ///< of 6, held by the prior
  std::optional<MemoryDecision> memory;  ///< of a key scan, by a method that selects
  bool used_prior_only = false;          ///< too few correspondences: the prior alone gave the pose
};

}  // namespace vsslam

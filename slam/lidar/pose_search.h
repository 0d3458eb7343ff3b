// Where about is the scan? Poses on a grid around the prior, each judged by how well the scan fits the local map there.
// For starts in motion, when nothing tells how fast, and for finding again what was lost.
#pragma once

#include <vector>

#include "slam/lidar/features.h"
#include "slam/lidar/plane_map.h"
#include "slam/lidar/registration.h"

namespace vsslam {

struct PoseSearchConfig {
  /// Looked for where registration from the prior alone could miss: where the prior may err (3 sigma) by more than
  /// registration's own reach.
  double reach_m = 0.3;
  int features = 400;    ///< that judge a pose; registration takes all
  int finalists = 6;     ///< that are registered
  /// Share of the features by which a pose must fit better than what the prior says, lest noise decide along a corridor.
  double clearly_better = 0.05;
  double max_m = 6.0;    ///< farthest from the prior
  double max_rad = 0.5;
  void fields(Fields& f);
};

/// Whether registration from the prior could miss. `range_m` is how far the scan looks: a turn moves it by as much.
bool needs_search(const PosePrior& prior, double range_m, const PoseSearchConfig& config);

/// Up to `finalists` poses within 3 sigma of the prior (moved in its x and y, turned about its z) where the scan fits
/// better than at the prior itself, the best first; none beside another.
std::vector<SE3> likely_poses(const std::vector<Feature>& features, const PosePrior& prior, double range_m,
                              const PlaneMap& map, double range_sigma_m, const PoseSearchConfig& config);

}  // namespace vsslam

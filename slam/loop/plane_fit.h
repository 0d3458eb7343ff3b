// Point-to-plane refinement of a loop's pose.
//
// Point-to-point ICP draws a scan to where the map has points: back into the map where the scan looks beyond its
// end, and along a wall to the sampling of the wall. A plane lets the scan slide, so what does not resist a motion
// does not ask for one either. Directions that too few pairs see are no measurement, and the pose keeps what is
// expected there (solution remapping, see slam/lidar/degeneracy.h).
#pragma once

#include "slam/lidar/degeneracy.h"
#include "slam/loop/icp.h"

namespace vsslam {

struct PlaneFitConfig {
  double max_pair_m = 0.5;  ///< of a source point from its target point
  int min_pairs = 50;       ///< fewer: the target has too few planes to fit to
  int max_iterations = 30;
  double step_translation_m = 1e-3, step_rotation_rad = 1.414e-3;  ///< converged below
  double max_normal_sigma_rad = 0.05;  ///< of the target's planes, as in PlaneMapConfig
  double range_sigma_m = 0.007;        ///< likewise
  DegeneracyConfig degeneracy;
};

struct PlaneFit {
  SE3 T_target_source;
  int pairs = 0;  ///< at the last iteration
  int iterations = 0;
  bool converged = false;
  Degeneracy degeneracy;  ///< at the last iteration, about the origin of the source
};

/// Minimises sum w_i (n_i . (T p_i - q_i))^2 over T = T_target_source from `start`, where q_i is the target point
/// nearest to T p_i and n_i the normal of the target about q_i. Directions that the pairs do not see go to
/// `T_target_source_expected`. With fewer than `min_pairs` at the start it stays there.
PlaneFit fit_to_planes(const Cloud& source, const IcpTarget& target, const SE3& start,
                       const SE3& T_target_source_expected, const PlaneFitConfig& config);

}  // namespace vsslam

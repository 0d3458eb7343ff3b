// Point-to-plane Gauss-Newton of a scan against the local map, about the sensor.
#pragma once

#include <vector>

#include "core/config.h"
#include "slam/lidar/degeneracy.h"
#include "slam/lidar/features.h"
#include "slam/lidar/information.h"
#include "slam/lidar/plane_map.h"

namespace vsslam {

struct RegistrationConfig {
  int max_iterations = 30;
  int min_correspondences = 50;   ///< fewer: the prior alone gives the pose
  double max_distance_m = 0.3;    ///< of a point from its plane, first iteration
  double final_distance_m = 0.1;  ///< and once the steps are small
  double robust_scale_m = 0.03;   ///< Cauchy: weight 1 / (1 + (r / scale)^2)
  double converged_rotation_deg = 0.005;
  double converged_translation_m = 1e-4;
  void fields(Fields& f);
};

struct Registration {
  SE3 T_odom_lidar;
  Information information;  ///< unweighted, at the last iteration
  Degeneracy degeneracy;    ///< at the last iteration
  int correspondences = 0;
  int iterations = 0;
  bool converged = false;
  bool used_prior_only = false;
};

/// Minimises sum w_i (n_i . (T p_i) - d_i)^2 over T = T_odom_lidar, starting from the prior; directions that
/// the scan does not see keep the prior.
Registration register_scan(const std::vector<Feature>& features, const SE3& T_odom_lidar_prior,
                           const PlaneMap& map, const RegistrationConfig& config,
                           const DegeneracyConfig& degeneracy);

}  // namespace vsslam

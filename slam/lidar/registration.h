// Point-to-plane Gauss-Newton of a scan against the local map, about the sensor.
#pragma once

#include <optional>
#include <vector>

#include "core/config.h"
#include "slam/lidar/degeneracy.h"
#include "slam/lidar/features.h"
#include "slam/lidar/information.h"
#include "slam/lidar/plane_map.h"

namespace vsslam {

struct RegistrationConfig {
  /// covariance: scan and prior are weighed by their covariances in one problem, so that what the scan does not see the
  /// prior gives by itself. remapping: the scan alone decides in the directions that it sees (DegeneracyConfig), the
  /// prior alone in the others (Zhang et al. 2016), as published.
  enum class Weighting { covariance, remapping };
  Weighting weighting = Weighting::covariance;
  int max_iterations = 30;
  int min_correspondences = 50;  ///< fewer: the prior alone gives the pose
  double max_distance_m = 0.3;   ///< of a point from its plane, first iteration; more if the prior may err by more
  /// And once the steps are small. Automatic: 0.1 m, which planes and poses may err by, or 5 times the noise of ranges.
  std::optional<double> final_distance_m;
  /// Cauchy: weight 1 / (1 + (r / scale)^2). Automatic: 4.3 times the noise of ranges.
  std::optional<double> robust_scale_m;
  /// A prior farther than so many sigma from where the scan fits is believed ever less (Cauchy): far more than one that
  /// is merely worse than it claims, which is left to PriorTrust.
  double prior_sigmas = 20;
  /// Where in its beam an echo comes from is not known: evenly within the 3 mrad of a VLP-16's sheet. The slanted surfaces
  /// that are seen far away look shifted by as much, all their points alike.
  double beam_sigma_rad = 0.00087;
  double converged_rotation_deg = 0.005;
  double converged_translation_m = 1e-4;
  void fields(Fields& f);
};

/// Where the scan is believed to be before it is looked at.
struct PosePrior {
  SE3 T_odom_lidar;
  Mat6 covariance = Mat6::Identity();  ///< of a right perturbation [rotation; translation]
};

/// How scan and map err.
struct ScanNoise {
  double range_sigma_m = 0.01;  ///< each point by itself
  /// Scans in a row that meet the same planes, and so the same errors of theirs: together they know no more of the pose
  /// than the planes do.
  double scans_sharing_planes = 1;
};

struct Registration {
  SE3 T_odom_lidar;
  Mat6 covariance = Mat6::Identity();         ///< of T_odom_lidar, right perturbation: scan and prior together
  Mat6 scan_information = Mat6::Zero();       ///< what the scan alone says of it
  Information information;  ///< unweighted, at the last iteration, without what the noise of normals feigns
  Degeneracy degeneracy;    ///< at the last iteration
  int correspondences = 0;
  double cost = 0;          ///< mean over the features of the robust cost, in 0..1; a feature without plane costs 1
  double misfit = 0;        ///< the same over those with a plane: how badly what is seen again fits
  int iterations = 0;
  bool converged = false;
  bool used_prior_only = false;
};

/// Minimises sum w_i (n_i . (T p_i) - d_i)^2 + xi' P^-1 xi over T = T_odom_lidar, xi = Log(T_prior^-1 T), starting from
/// `start`. The w_i are those of noisy points on planes that err as a whole.
Registration register_scan(const std::vector<Feature>& features, const PosePrior& prior, const SE3& start,
                           const PlaneMap& map, const ScanNoise& noise, const RegistrationConfig& config,
                           const DegeneracyConfig& degeneracy);

/// Features that lie on planes of the map.
int count_matches(const std::vector<Feature>& features, const SE3& T_odom_lidar, const PlaneMap& map, double range_sigma_m,
                  const RegistrationConfig& config);

/// What a scan at T_odom_lidar says of its pose beside that of another scan, which met the same map: errors of planes that
/// both met move both alike. `plane_share` of a plane's variance is new to each of them.
Mat6 step_information(const std::vector<Feature>& features, const SE3& T_odom_lidar, const PlaneMap& map,
                      double range_sigma_m, double plane_share, const RegistrationConfig& config);

}  // namespace vsslam

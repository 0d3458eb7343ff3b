// Which directions of the pose does a scan not see? Zhang, Kaess, Singh, "On Degeneracy of Optimization-based
// State Estimation Problems", ICRA 2016, with a threshold that does not depend on how many points there are.
//
// H = sum J^T J over N correspondences, J = [(p x n)^T, n^T]. Scaling rotations by a length L makes the
// blocks comparable: with S = diag(1/L, 1/L, 1/L, 1, 1, 1), H' = S H S / N has the eigenvalues
//
//     l_k = 1/N sum_i (J_i S v_k)^2
//
// the mean square of how far the planes move against the points when the pose moves one metre (or turns
// 1 m / L) along v_k. The translational part sums to 1, since |n| = 1: l_k is the share of the
// correspondences that see the direction. Doubling the points or the voxels' size leaves it as it is.
//
// Fitted normals tilt by at most sigma_n (PlaneMapConfig::max_normal_sigma_rad), which alone feigns a share of
// up to sigma_n^2 = 0.0025 in a direction that no surface sees; in an endless corridor with 7 mm of range noise
// 2e-5 was measured. Door jambs 15 cm deep every 4 m give about 0.02, 10 cm deep ones 0.001, too little to trust.
#pragma once

#include "core/config.h"
#include "core/se3.h"

namespace vsslam {

struct DegeneracyConfig {
  double min_share = 0.01;               ///< l_k below this: degenerate
  double characteristic_length_m = 1.0;  ///< L: an error of 1 rad harms as much as one of L metres
  void fields(Fields& f);
};

struct Degeneracy {
  Mat6 scaled_eigenvectors = Mat6::Identity();  ///< of H', in columns, ascending
  Vec6 shares = Vec6::Zero();                   ///< l_k, ascending
  int directions = 6;                           ///< the first `directions` columns are degenerate
  double characteristic_length_m = 1.0;

  /// Solution remapping: minimises 1/2 x^T A x - b^T x over the observed directions only, so that x = 0 (the
  /// prior) stays in the degenerate ones. With V_kept the observed columns, x = S V_kept (V_kept^T S A S
  /// V_kept)^-1 V_kept^T S b; where A = H this is V_kept V_kept^T applied to the full solution.
  Vec6 solve(const Mat6& A, const Vec6& b) const;
  /// The part of a step [rotation; translation] that lies in the degenerate directions.
  Vec6 unseen_part(const Vec6& step) const;
  /// Information of a pose measured in the observed directions only, with the variances `seen` [rad^2; m^2], and
  /// believed with `unseen_variance` in the degenerate ones, in m^2, or rad^2 times L^2. Positive definite.
  Mat6 information(const Vec6& seen, double unseen_variance) const;
  /// Projector on the observed rotations and translations, sensor frame: 3 x 3 blocks of V_kept V_kept^T.
  Mat3 observed_rotation() const;
  Mat3 observed_translation() const;
};

Degeneracy detect_degeneracy(const Mat6& H, int correspondences, const DegeneracyConfig& config);

}  // namespace vsslam

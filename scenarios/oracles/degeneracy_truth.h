// Truth of degeneracy: the information that the scene itself gives about a pose, and a detector's score
// against it.
#pragma once

#include <optional>
#include <span>

#include "sensors/measurement/samples.h"
#include "slam/lidar/information.h"

namespace vsslam {

struct DegeneracyTruthOptions {
  double voxel_m = 0.4;  ///< thinning, as the estimator's: one point per voxel and facing of the surface
  /// A direction is degenerate if its eigenvalue per point is below this: the mean square of how far (m) the
  /// planes move against the points per m, or per rad, of motion along the direction. For translations it is the
  /// share of the points that see the direction, the same measure that the estimator's detector takes of its own
  /// correspondences; equal thresholds judge how well it measures, not how bold it is.
  double translation_threshold = 0.01;
  double rotation_threshold_m2 = 0.01;
};

struct DegeneracyTruth {
  Information
      information;  ///< of the thinned noise-free points with true normals, lidar frame at the scan's stamp
  int points = 0;
  int degenerate_translations = 0,
      degenerate_rotations = 0;  ///< the first so many eigenvectors of each block
  int degenerate_directions() const { return degenerate_translations + degenerate_rotations; }
};

DegeneracyTruth degeneracy_truth(const LidarMeasurement& measurement,
                                 const DegeneracyTruthOptions& options = {});

/// What the detector said of the same scan.
struct DegeneracyReport {
  Information information;
  int degenerate_directions = 0;
};

/// Counts scans: a detection is a scan with at least one degenerate direction.
struct DegeneracyScore {
  int detected = 0, true_degenerate = 0, both = 0;
  std::optional<double> precision,
      recall;  ///< both / detected, both / true_degenerate; absent: division by none
  /// Over scans that both call degenerate: angle between the estimator's weakest direction of a block and the
  /// true degenerate directions of that block (their span).
  std::optional<double> direction_error_deg_median;
};

DegeneracyScore score_degeneracy(std::span<const DegeneracyReport> reports,
                                 std::span<const DegeneracyTruth> truth);

}  // namespace vsslam

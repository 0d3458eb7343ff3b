// Planar features of a scan (Zhang & Singh, RSS 2014; settings as published for LIO-SAM and LVI-SAM, except
// where a comment says otherwise).
#pragma once

#include <optional>
#include <vector>

#include "core/config.h"
#include "core/samples.h"
#include "slam/lidar/cloud.h"
#include "slam/lidar/ring_order.h"

namespace vsslam {

struct FeatureConfig {
  /// Neighbours on either side in the ring; more where the chord would be shorter than five times the noise, which would
  /// say nothing of the surface's direction.
  int half_window = 5;
  int short_half_window = 2;  ///< tried where the long window meets an edge: keeps narrow faces (door jambs)
  /// Largest distance of a neighbour from the line along the chord. Automatic: 4.3 times the noise of ranges, which one
  /// window in a thousand exceeds on a plane.
  std::optional<double> planar_threshold_m;
  /// Range step that makes the farther side a shadow edge; at least 6 times the noise.
  double occlusion_jump_m = 0.3;
  int occlusion_neighbours = 6;      ///< points dropped on the farther side
  double parallel_beam_deg =
      80.0;  ///< larger angle of incidence in the ring's direction: beam parallel to surface
  double min_range_m = 1.0;
  void fields(Fields& f);
};

/// A planar point and the chord of its window: it runs along the surface, in the ring's direction.
struct Feature {
  Eigen::Vector3f point_lidar;
  Eigen::Vector3f chord_lidar;  ///< m; not normalised, since its noise does not grow with its length
  uint16_t ring = 0;
};

/// The range step of a RingOrder for these features.
double range_step_m(double range_sigma_m, const FeatureConfig& config);

/// `points_lidar` are the undistorted scan.points, same order; `range_sigma_m` is the noise of ranges. Features come
/// in a scattered order (scattered_order.h).
std::vector<Feature> select_planar_features(const LidarScan& scan, const Cloud& points_lidar,
                                            double range_sigma_m, const FeatureConfig& config);

/// The same as thin_features(select_planar_features(...), voxel_m), several times faster. Changes what `order` says of
/// shadows.
std::vector<Feature> select_thin_features(RingOrder& order, double range_sigma_m, const FeatureConfig& config,
                                          double voxel_m);

/// At most one feature (the first) per cube of `voxel_m` and per direction of the chord: surfaces that meet
/// at a right angle do not hide each other.
std::vector<Feature> thin_features(const std::vector<Feature>& features, double voxel_m);

}  // namespace vsslam

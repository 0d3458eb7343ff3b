// Planar features of a scan (Zhang & Singh, RSS 2014; settings as published for LIO-SAM and LVI-SAM, except
// where a comment says otherwise).
#pragma once

#include <vector>

#include "core/config.h"
#include "core/samples.h"
#include "slam/lidar/cloud.h"

namespace vsslam {

struct FeatureConfig {
  int half_window = 5;        ///< neighbours on either side in the ring
  int short_half_window = 2;  ///< tried where the long window meets an edge: keeps narrow faces (door jambs)
  double planar_threshold_m = 0.03;  ///< largest distance of a neighbour from the line along the chord
  double occlusion_jump_m = 0.3;     ///< range step that makes the farther side a shadow edge
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

/// `points_lidar` are the undistorted scan.points, same order. Features come ring by ring in order of time.
std::vector<Feature> select_planar_features(const LidarScan& scan, const Cloud& points_lidar, int rings,
                                            const FeatureConfig& config);

/// The same as thin_features(select_planar_features(...), voxel_m), several times faster.
std::vector<Feature> select_thin_features(const LidarScan& scan, const Cloud& points_lidar, int rings,
                                          const FeatureConfig& config, double voxel_m);

/// At most one feature (the first) per cube of `voxel_m` and per direction of the chord: surfaces that meet
/// at a right angle do not hide each other.
std::vector<Feature> thin_features(const std::vector<Feature>& features, double voxel_m);

}  // namespace vsslam

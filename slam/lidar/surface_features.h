// Planar points of a scan whose rings say nothing: normals come from neighbours in space.
#pragma once

#include <vector>

#include "slam/lidar/features.h"

namespace vsslam {

/// One feature per cube of `voxel_m` at most. `chord_lidar` is a tangent of the surface, horizontal as a ring's would
/// be, and `ring` the elevation in degrees above -90: what the local map tells surfaces and lines apart by.
/// `points_lidar` are the undistorted scan.points, same order; `range_sigma_m` is the noise of ranges.
std::vector<Feature> select_surface_features(const Cloud& points_lidar, double range_sigma_m, double voxel_m,
                                             const FeatureConfig& config);

/// How far points scatter about the planes through their neighbours, m: the median over planar places. 0 if there are
/// too few.
double measured_surface_sigma_m(const Cloud& points_lidar, double voxel_m, const FeatureConfig& config);

}  // namespace vsslam

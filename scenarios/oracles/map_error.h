// How far the estimated map lies from the true surfaces.
#pragma once

#include <memory>

#include "core/se3.h"
#include "slam/lidar/cloud.h"
#include "worlds/world.h"

namespace vsslam {

/// Exact distance to the nearest triangle of a world, through a tree of boxes. Built once per world.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const World& world);
  SurfaceDistance(SurfaceDistance&&) noexcept;
  ~SurfaceDistance();

  /// Distance in m from a point to the nearest surface; infinite for a world without triangles. Thread-safe.
  double operator()(const Vec3& point_world) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

struct MapError {
  double mean_m = 0, max_m = 0;
  size_t points = 0;  ///< that were measured
};

/// T_world_map: alignment of the trajectories (TrajectoryScore::T_truth_estimate). Of larger maps every n-th
/// point counts.
MapError map_error(const Cloud& points_map, const SE3& T_world_map, const SurfaceDistance& surface,
                   size_t max_points = 20'000);

}  // namespace vsslam

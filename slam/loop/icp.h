// Point-to-point ICP (Besl and McKay 1992) against a cloud that is searched many times.
#pragma once

#include <memory>

#include "slam/lidar/cloud.h"
#include "slam/loop/loop_config.h"

namespace vsslam {

/// A cloud with its kd-tree.
class IcpTarget {
 public:
  explicit IcpTarget(Cloud points);
  ~IcpTarget();
  IcpTarget(const IcpTarget&) = delete;
  IcpTarget& operator=(const IcpTarget&) = delete;

  const Cloud& points() const { return points_; }

  struct Neighbours {
    int nearest = -1;           ///< index, -1: none within the radius
    float distance_m = 0;       ///< to the nearest
    float next_distance_m = 0;  ///< to the second nearest, or the radius if there is none within it
  };
  Neighbours find(const Eigen::Vector3f& point, float radius_m) const;
  /// The `count` points nearest to `point`, nearest first; all if there are no more.
  Cloud nearest(const Eigen::Vector3f& point, int count) const;

 private:
  class Tree;
  Cloud points_;
  std::unique_ptr<Tree> tree_;
};

struct IcpResult {
  SE3 T_target_source;
  int iterations = 0;
  bool converged = false;   ///< false: fewer than 3 correspondences
  double fitness_m2 = -1;   ///< mean squared distance of the correspondences at the solution, -1: none
  double inlier_ratio = 0;  ///< share of source points with a correspondence at the solution
  double overlap = 0;       ///< share of source points within `overlap_distance_m` of a target point
};

/// Each iteration pairs every source point with its nearest target point, if that is within
/// max_correspondence_m, and takes the closed-form transform of these pairs.
IcpResult align(const Cloud& source, const IcpTarget& target, const SE3& T_target_source,
                const IcpConfig& config, double overlap_distance_m);

/// Fitness, inlier ratio and overlap at result.T_target_source.
void score(const Cloud& source, const IcpTarget& target, double max_correspondence_m,
           double overlap_distance_m, IcpResult& result);

}  // namespace vsslam

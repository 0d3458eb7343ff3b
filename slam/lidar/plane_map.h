// The local map: cubes of space with the plane fitted to the points in them, coarse where one plane explains
// a cube and finer where it does not (in the spirit of Yuan et al., "Efficient and Probabilistic Adaptive
// Voxel Mapping", RA-L 2022).
#pragma once

#include <deque>
#include <vector>

#include "core/config.h"
#include "core/se3.h"
#include "slam/lidar/voxel_hash.h"

namespace vsslam {

struct PlaneMapConfig {
  double cell_m = 0.8;  ///< edge of the coarsest cubes
  int levels = 4;       ///< each level halves the edge
  int min_points = 10;  ///< of a plane
  int min_lines = 3;    ///< a ring that runs over a corner makes a plane that is not there; three do not
  double max_thickness_m = 0.015;  ///< RMS distance of the points from their plane
  double max_normal_sigma_rad =
      0.05;                      ///< uncertainty of the normal, from the spread and number of the points
  double range_sigma_m = 0.007;  ///< points are never believed better than this
  void fields(Fields& f);
};

/// A point and the line of the scan pattern (key scan and ring) that it was sampled on.
struct MapPoint {
  Eigen::Vector3f point_odom;
  uint32_t line = 0;
};

/// n . x = d in the odom frame.
struct Plane {
  Eigen::Vector3f normal_odom = Eigen::Vector3f::Zero();
  float distance_m = 0;
};

class PlaneMap {
 public:
  explicit PlaneMap(const PlaneMapConfig& config) : config_(config) {}

  /// Replaces the content by the points of all key scans. Deterministic: sums run in their order.
  void rebuild(const std::deque<std::vector<MapPoint>>& keys_odom);
  /// The plane of the coarsest cube around the point that has one; nullptr if none. Never a neighbour's: near
  /// an edge that is the wrong surface.
  const Plane* find(const Eigen::Vector3f& point_odom) const;
  size_t plane_count() const;

 private:
  struct Level {
    float inverse_cell = 1;
    KeyIndex index;
    std::vector<Plane> planes;  // by number of the cell
    std::vector<uint8_t> planar;
  };
  PlaneMapConfig config_;
  std::vector<Level> levels_;
};

}  // namespace vsslam

// The local map: cubes of space with the planes fitted to the points in them, coarse where they explain a cube
// and finer where they do not (in the spirit of Yuan et al., "Efficient and Probabilistic Adaptive Voxel
// Mapping", RA-L 2022).
//
// Where two surfaces meet at a right angle (a door jamb and its wall) a cube holds both. The chords of the
// scan's rings tell them apart: a cube has a frame of two perpendicular horizontal axes, the one its points'
// chords fit best, and each point belongs to the axis nearer to its chord. If one plane does not explain the
// cube, each class may have its own.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/config.h"
#include "core/se3.h"
#include "slam/lidar/voxel_hash.h"

namespace vsslam {

struct PlaneMapConfig {
  /// Edge of the coarsest cubes: three lines of a VLP-16, 2 degrees apart, on a wall 100 m away, with room to spare for
  /// scanners of fewer lasers.
  double cell_m = 12.8;
  int levels = 7;       ///< each level halves the edge
  int min_points = 10;  ///< of a plane
  int min_lines = 3;    ///< a ring that runs over a corner makes a plane that is not there; three do not
  /// RMS distance of the points from their plane. Automatic: the noise of ranges, as far as so many points can tell, and
  /// three times plane_sigma_m.
  std::optional<double> max_thickness_m;
  /// What a plane errs by beside the noise of its points: lasers that are biased, surfaces that are not flat, poses that
  /// bent the map. Over the plane's extent it is also a tilt.
  double plane_sigma_m = 0.003;
  /// Uncertainty of the normal, from the spread and number of the points. What it feigns is taken away again
  /// (registration.h), so narrow faces may speak.
  double max_normal_sigma_rad = 0.1;
  /// A point whose chord leaves the plane by more lies on another surface. Automatic: 3 times the noise of the
  /// difference of two ranges.
  std::optional<double> max_chord_tilt_m;
  void fields(Fields& f);
};

/// A point of a key scan, with the chord of its window and the line of the scan pattern (key scan and ring) that
/// it was sampled on.
struct MapPoint {
  Eigen::Vector3f point_odom, chord_odom;
  uint32_t line = 0;
};

/// n . x = d in the odom frame, and how well that is known.
struct Plane {
  Eigen::Vector3f normal_odom = Eigen::Vector3f::Zero();
  float distance_m = 0;
  Eigen::Vector3f center_odom = Eigen::Vector3f::Zero();
  Eigen::Vector3f axis_odom[2] = {Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};  ///< in the plane
  float center_variance_m2 = 0;        ///< across the plane, at the center
  float tilt_variance[2] = {0, 0};     ///< rad^2, of the normal towards each axis
  int number = 0;                      ///< 0, 1, 2, ... in a map

  /// Of the plane's distance from a point on it.
  float variance_m2(const Eigen::Vector3f& point_odom) const {
    const Eigen::Vector3f from_center = point_odom - center_odom;
    const float u = axis_odom[0].dot(from_center), v = axis_odom[1].dot(from_center);
    return center_variance_m2 + tilt_variance[0] * u * u + tilt_variance[1] * v * v;
  }
};

class PlaneMap {
 public:
  explicit PlaneMap(const PlaneMapConfig& config) : config_(config) {}

  /// Replaces the content by the points of all key scans, whose ranges are as noisy as that. Deterministic: sums run
  /// in their order.
  void rebuild(const std::deque<std::vector<MapPoint>>& keys_odom, double range_sigma_m);
  /// The plane of the coarsest cube around the point that has one for its chord; nullptr if none. Never a
  /// neighbour's: near an edge that is the wrong surface.
  const Plane* find(const Eigen::Vector3f& point_odom, const Eigen::Vector3f& chord_odom) const;
  size_t plane_count() const { return static_cast<size_t>(planes_); }

 private:
  struct Cell {
    Eigen::Vector2f axis = Eigen::Vector2f::UnitX();  // class 0 runs along it, class 1 across
    bool planar[2] = {false, false};
    Plane plane[2];
    int chord_class(const Eigen::Vector3f& chord) const {
      const float along = chord.x() * axis.x() + chord.y() * axis.y();
      const float across = chord.y() * axis.x() - chord.x() * axis.y();
      return std::abs(along) >= std::abs(across) ? 0 : 1;
    }
  };
  struct Level {
    float inverse_cell = 1;
    KeyIndex index;
    std::vector<Cell> cells;  // by number of the key
  };
  void build_level(Level& level, std::vector<MapPoint>& points);

  PlaneMapConfig config_;
  double range_sigma_m_ = 0;
  float max_chord_tilt_m_ = 0;
  int planes_ = 0;
  std::vector<Level> levels_;
};

}  // namespace vsslam

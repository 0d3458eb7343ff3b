// Points that may lie on a plane: what their mean and mean square say of its normal.
#pragma once

#include "core/se3.h"

namespace vsslam {

struct Patch {
  /// `mean` (3) and `mean_square` (3 x 3) of the points about any origin; `point_count` of them.
  Patch(const Vec3& mean, const Mat3& mean_square, double point_count);

  Vec3 normal;     ///< unit length, either sign
  Mat3 axes;       ///< the principal axes in columns; the first is the normal
  Vec3 spread_m2;  ///< variances along the principal axes, ascending: across the plane first
  double count;

  /// Variance across the plane, not believed below that of the ranges.
  double thickness_m2(double range_sigma_m) const;
  /// Variances (rad^2) of the normal's tilt towards axes 1 and 2: thickness / (count * spread along the axis).
  Eigen::Vector2d normal_variance(double range_sigma_m) const;
  /// What a normal feigns of a direction that no surface sees stays below a share of max_normal_sigma_rad^2 (see
  /// degeneracy.h).
  bool normal_is_known(double max_normal_sigma_rad, double range_sigma_m) const;
};

}  // namespace vsslam

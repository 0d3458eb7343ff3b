// Points that may lie on a plane: what their mean and mean square say of its normal.
#pragma once

#include "core/se3.h"

namespace vsslam {

struct Patch {
  /// `mean` (3) and `mean_square` (3 x 3) of the points about any origin; `point_count` of them.
  Patch(const Vec3& mean, const Mat3& mean_square, double point_count);

  Vec3 normal;     ///< unit length, either sign
  Vec3 spread_m2;  ///< variances along the principal axes, ascending: across the plane first
  double count;

  /// The standard deviation of the normal is sigma / sqrt(count * spread along the shorter side), with sigma the
  /// thickness of the patch, but not believed below `range_sigma_m`. What a normal feigns of a direction that no
  /// surface sees stays below a share of max_normal_sigma_rad^2 (see degeneracy.h).
  bool normal_is_known(double max_normal_sigma_rad, double range_sigma_m) const;
};

}  // namespace vsslam

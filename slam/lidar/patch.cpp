#include "slam/lidar/patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace vsslam {

Patch::Patch(const Vec3& mean, const Mat3& mean_square, double point_count) : count(point_count) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(mean_square - mean * mean.transpose());
  spread_m2 = solver.eigenvalues();
  normal = solver.eigenvectors().col(0).normalized();
}

bool Patch::normal_is_known(double max_normal_sigma_rad, double range_sigma_m) const {
  const double variance_m2 = std::max(spread_m2[0], range_sigma_m * range_sigma_m);
  return variance_m2 <= max_normal_sigma_rad * max_normal_sigma_rad * count * spread_m2[1];
}

}  // namespace vsslam

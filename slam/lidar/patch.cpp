#include "slam/lidar/patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace vsslam {

Patch::Patch(const Vec3& mean, const Mat3& mean_square, double point_count) : count(point_count) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(mean_square - mean * mean.transpose());
  spread_m2 = solver.eigenvalues();
  axes = solver.eigenvectors();
  normal = axes.col(0).normalized();
}

double Patch::thickness_m2(double range_sigma_m) const {
  return std::max(spread_m2[0], range_sigma_m * range_sigma_m);
}

Eigen::Vector2d Patch::normal_variance(double range_sigma_m) const {
  constexpr double kPoint_m2 = 1e-9;  // no patch is so short
  return thickness_m2(range_sigma_m) / count * spread_m2.tail<2>().cwiseMax(kPoint_m2).cwiseInverse();
}

bool Patch::normal_is_known(double max_normal_sigma_rad, double range_sigma_m) const {
  return thickness_m2(range_sigma_m) <= max_normal_sigma_rad * max_normal_sigma_rad * count * spread_m2[1];
}

}  // namespace vsslam

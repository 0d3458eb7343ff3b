#include "slam/lidar/degeneracy.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace vsslam {

void DegeneracyConfig::fields(Fields& f) {
  f("min_share", min_share, between(0, 1));
  f("characteristic_length_m", characteristic_length_m, positive());
}

namespace {

// Some of the six directions, without the heap.
using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using SmallSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

Vec6 scaling(double length_m) {
  Vec6 s;
  s << Vec3::Constant(1.0 / length_m), Vec3::Ones();
  return s;
}

}  // namespace

Degeneracy detect_degeneracy(const Mat6& H, int correspondences, const DegeneracyConfig& config) {
  Degeneracy found;
  found.characteristic_length_m = config.characteristic_length_m;
  if (correspondences == 0) return found;
  const Vec6 s = scaling(config.characteristic_length_m);
  const Mat6 scaled = s.asDiagonal() * H * s.asDiagonal() / correspondences;
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(scaled);
  found.scaled_eigenvectors = solver.eigenvectors();
  found.shares = solver.eigenvalues().cwiseMax(0.0);
  found.directions = 0;
  while (found.directions < 6 && found.shares[found.directions] < config.min_share) ++found.directions;
  return found;
}

Vec6 Degeneracy::solve(const Mat6& A, const Vec6& b) const {
  if (directions == 6) return Vec6::Zero();
  const Vec6 s = scaling(characteristic_length_m);
  const Basis basis = s.asDiagonal() * scaled_eigenvectors.rightCols(6 - directions);
  const SmallSquare reduced = basis.transpose() * A * basis;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> right = basis.transpose() * b;
  return basis * reduced.ldlt().solve(right);
}

Vec6 Degeneracy::unseen_part(const Vec6& step) const {
  const Vec6 s = scaling(characteristic_length_m);
  const auto unseen = scaled_eigenvectors.leftCols(directions);
  return s.cwiseProduct(unseen * (unseen.transpose() * step.cwiseQuotient(s)));
}

// With x = S y, the observed part K^T y has the covariance K^T S^-1 C S^-1 K, the rest U^T y its own.
Mat6 Degeneracy::information(const Vec6& seen, double unseen_variance) const {
  const Vec6 inverse = scaling(characteristic_length_m).cwiseInverse();
  const Basis unseen = inverse.asDiagonal() * scaled_eigenvectors.leftCols(directions);
  Mat6 sum = unseen * unseen.transpose() / unseen_variance;
  if (directions == 6) return sum;
  const Basis kept = inverse.asDiagonal() * scaled_eigenvectors.rightCols(6 - directions);
  const SmallSquare covariance = kept.transpose() * seen.asDiagonal() * kept;
  sum += kept * covariance.ldlt().solve(kept.transpose());
  return sum;
}

Mat3 Degeneracy::observed_rotation() const {
  const auto kept = scaled_eigenvectors.rightCols(6 - directions).topRows<3>();
  return kept * kept.transpose();
}

Mat3 Degeneracy::observed_translation() const {
  const auto kept = scaled_eigenvectors.rightCols(6 - directions).bottomRows<3>();
  return kept * kept.transpose();
}

}  // namespace vsslam

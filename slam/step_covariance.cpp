#include "slam/step_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <utility>

#include "slam/inertial/pose_covariance.h"

namespace vsslam {

void StepCovariance::add_prediction(const SE3& T_last_predicted, const Mat6& last, const Mat6& predicted) {
  missed_ = moved_covariance(missed_ - last, T_last_predicted) + predicted;
}

Mat6 StepCovariance::add_key(const SE3& T_odom_base, const Mat6& known) {
  constexpr double kLeast = 1e-9;  // (0.03 mm)^2: differences of covariances may come out as nothing, or less
  const std::optional<Key> last = std::exchange(last_key_, Key{T_odom_base, known});
  const Eigen::SelfAdjointEigenSolver<Mat6> missed(std::exchange(missed_, Mat6::Zero()));
  if (!last) return known;
  const Mat6 by_priors = missed.eigenvectors() *
                         missed.eigenvalues().cwiseMax(kLeast).cwiseInverse().asDiagonal() *
                         missed.eigenvectors().transpose();
  const Mat6 scans = moved_covariance(last->known, last->T_odom_base.inverse() * T_odom_base) + known;
  return (by_priors + scans.ldlt().solve(Mat6::Identity())).ldlt().solve(Mat6::Identity());
}

}  // namespace vsslam

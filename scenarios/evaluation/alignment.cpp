#include "scenarios/evaluation/alignment.h"

#include <Eigen/SVD>

namespace vsslam {

namespace {

Vec3 mean(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The rotation of Umeyama's equations (40)-(43): R = U S V^T with S fixing the handedness. Only directions
/// in which the points really extend may count; where fewer than two do, the rotation that moves least is
/// taken.
Mat3 best_rotation(const Mat3& covariance, Vec3& singular_values) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  singular_values = svd.singularValues();
  const double negligible = 1e-12 * singular_values[0];
  if (!(singular_values[0] > 0)) return Mat3::Identity();
  if (singular_values[1] <= negligible)
    return Quat::FromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0)).toRotationMatrix();
  Vec3 sign = Vec3::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
  singular_values[2] *= sign[2];
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Similarity align_points(std::span<const Vec3> estimate, std::span<const Vec3> truth, bool with_scale) {
  const Vec3 mean_estimate = mean(estimate), mean_truth = mean(truth);
  Mat3 covariance = Mat3::Zero();
  double variance = 0;
  for (size_t i = 0; i < estimate.size(); ++i) {
    const Vec3 from = estimate[i] - mean_estimate;
    covariance += (truth[i] - mean_truth) * from.transpose();
    variance += from.squaredNorm();
  }
  Vec3 singular_values;
  const Mat3 R = best_rotation(covariance, singular_values);
  Similarity result;
  if (with_scale && variance > 0 && singular_values.sum() > 0)
    result.scale = singular_values.sum() / variance;
  result.T_truth_estimate = SE3(Quat(R), mean_truth - result.scale * (R * mean_estimate));
  return result;
}

SE3 align_poses(std::span<const SE3> estimate, std::span<const SE3> truth) {
  Mat3 rotations = Mat3::Zero();
  Vec3 sum_estimate = Vec3::Zero(), sum_truth = Vec3::Zero();
  for (size_t i = 0; i < estimate.size(); ++i) {
    rotations += truth[i].matrix3() * estimate[i].matrix3().transpose();
    sum_estimate += estimate[i].translation;
    sum_truth += truth[i].translation;
  }
  Vec3 unused;
  const Mat3 R = best_rotation(rotations, unused);
  return {Quat(R), (sum_truth - R * sum_estimate) / static_cast<double>(estimate.size())};
}

}  // namespace vsslam

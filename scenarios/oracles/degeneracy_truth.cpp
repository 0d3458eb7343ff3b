#include "scenarios/oracles/degeneracy_truth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "slam/lidar/voxel_hash.h"

namespace vsslam {

namespace {

/// 0..5: the axis that a normal leans to most, and its sign.
unsigned facing(const Vec3f& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<unsigned>(2 * axis) + (normal[axis] < 0 ? 1u : 0u);
}

/// One point of each voxel and facing, the first: a voxel with a corner in it counts for every wall of the
/// corner. Indices in order of the points.
std::vector<size_t> thin(const std::vector<PointTruth>& points, double voxel_m) {
  const auto inverse = static_cast<float>(1.0 / voxel_m);
  KeyIndex seen(points.size() / 8);
  std::vector<size_t> kept;
  for (size_t i = 0; i < points.size(); ++i) {
    const auto number = static_cast<size_t>(
        seen.insert(voxel_key(points[i].position_lidar, inverse, facing(points[i].normal_lidar))));
    if (number == kept.size()) kept.push_back(i);
  }
  return kept;
}

int count_below(const InformationBlock& block, double threshold) {
  return static_cast<int>((block.eigenvalues.array() < threshold).count());
}

/// Angle between the estimator's weakest direction and the span of the true degenerate ones, rad.
double direction_error(const InformationBlock& estimated, const InformationBlock& truth, int degenerate) {
  const Vec3 direction = estimated.eigenvectors.col(0);
  double inside = 0;  // squared length of its projection
  for (int i = 0; i < degenerate; ++i) inside += std::pow(truth.eigenvectors.col(i).dot(direction), 2);
  return std::acos(std::sqrt(std::min(inside, 1.0)));
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

}  // namespace

DegeneracyTruth degeneracy_truth(const LidarMeasurement& measurement, const DegeneracyTruthOptions& options) {
  Mat6 H = Mat6::Zero();
  DegeneracyTruth result;
  for (const size_t i : thin(measurement.truth, options.voxel_m)) {
    const PointTruth& point = measurement.truth[i];
    const Vec6 row =
        point_to_plane_row(point.position_lidar.cast<double>(), point.normal_lidar.cast<double>());
    H += row * row.transpose();
    ++result.points;
  }
  result.information = analyse_information(H);
  result.degenerate_translations =
      count_below(result.information.translation, options.translation_threshold * std::max(1, result.points));
  result.degenerate_rotations =
      count_below(result.information.rotation, options.rotation_threshold_m2 * std::max(1, result.points));
  return result;
}

DegeneracyScore score_degeneracy(std::span<const DegeneracyReport> reports,
                                 std::span<const DegeneracyTruth> truth) {
  DegeneracyScore score;
  std::vector<double> errors_rad;
  for (size_t i = 0; i < std::min(reports.size(), truth.size()); ++i) {
    const bool detected = reports[i].degenerate_directions > 0,
               degenerate = truth[i].degenerate_directions() > 0;
    score.detected += detected;
    score.true_degenerate += degenerate;
    if (!detected || !degenerate) continue;
    ++score.both;
    const Information &estimated = reports[i].information, &exact = truth[i].information;
    if (const int n = truth[i].degenerate_translations; n > 0)
      errors_rad.push_back(direction_error(estimated.translation, exact.translation, n));
    if (const int n = truth[i].degenerate_rotations; n > 0)
      errors_rad.push_back(direction_error(estimated.rotation, exact.rotation, n));
  }
  if (score.detected > 0) score.precision = static_cast<double>(score.both) / score.detected;
  if (score.true_degenerate > 0) score.recall = static_cast<double>(score.both) / score.true_degenerate;
  if (!errors_rad.empty()) score.direction_error_deg_median = median(errors_rad) * 180 / std::numbers::pi;
  return score;
}

}  // namespace vsslam

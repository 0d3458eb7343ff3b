#include "slam/loop/plane_fit.h"

#include <optional>
#include <vector>

#include "slam/lidar/information.h"
#include "slam/lidar/patch.h"

namespace vsslam {

namespace {

/// Normal of the target about one of its points; none where its neighbours are no plane.
std::optional<Vec3> normal_about(const Eigen::Vector3f& point, const IcpTarget& target,
                                 const PlaneFitConfig& config) {
  constexpr int kNeighbours = 10;
  const Cloud neighbours = target.nearest(point, kNeighbours);
  const auto count = static_cast<double>(neighbours.size());
  Vec3 mean = Vec3::Zero();
  Mat3 square = Mat3::Zero();
  for (const Eigen::Vector3f& neighbour : neighbours) {
    const Vec3 offset = (neighbour - point).cast<double>();
    mean += offset / count;
    square += offset * offset.transpose() / count;
  }
  const Patch patch(mean, square, count);
  if (!patch.normal_is_known(config.max_normal_sigma_rad, config.range_sigma_m)) return std::nullopt;
  return patch.normal;
}

/// The target point of a source point, and the normal there.
struct Pair {
  int target = -1;
  std::optional<Vec3> normal;
};

/// The normal equations of one iteration, right perturbation.
struct NormalEquations {
  Mat6 A = Mat6::Zero();  ///< sum w J^T J
  Mat6 H = Mat6::Zero();  ///< sum J^T J: what the pairs see
  Vec6 b = Vec6::Zero();  ///< -sum w J^T e
  int pairs = 0;

  void add(const Vec3& point_source, const Vec3& normal_source, double distance_m) {
    constexpr double kRobustScale_m = 0.03;  // Cauchy, as in scan matching (RegistrationConfig)
    const double scaled = distance_m / kRobustScale_m, weight = 1 / (1 + scaled * scaled);
    const Vec6 row = point_to_plane_row(point_source, normal_source);
    A += weight * row * row.transpose();
    H += row * row.transpose();
    b -= weight * distance_m * row;
    ++pairs;
  }
};

/// Pairs of the source at T; `pairs` remembers those of the last time, since most keep their target.
NormalEquations normal_equations(const Cloud& source, const IcpTarget& target, const SE3& T_target_source,
                                 const PlaneFitConfig& config, std::vector<Pair>& pairs) {
  const Mat3 R_source_target = T_target_source.matrix3().transpose();
  NormalEquations sums;
  for (size_t i = 0; i < source.size(); ++i) {
    const Vec3 point_source = source[i].cast<double>(), point_target = T_target_source * point_source;
    const int nearest =
        target.find(point_target.cast<float>(), static_cast<float>(config.max_pair_m)).nearest;
    if (nearest < 0) continue;
    const Eigen::Vector3f& on_plane = target.points()[static_cast<size_t>(nearest)];
    if (nearest != pairs[i].target) pairs[i] = {nearest, normal_about(on_plane, target, config)};
    if (!pairs[i].normal) continue;
    const Vec3 offset = point_target - on_plane.cast<double>();
    sums.add(point_source, R_source_target * *pairs[i].normal, pairs[i].normal->dot(offset));
  }
  return sums;
}

/// What separates two poses, seen from the first: its rotation vector and, not bent by it, its translation.
Vec6 difference(const SE3& T_a_b, const SE3& T_a_c) {
  const Quat R_b_a = T_a_b.rotation.inverse();
  Vec6 between;
  between << so3_log(R_b_a * T_a_c.rotation), R_b_a * (T_a_c.translation - T_a_b.translation);
  return between;
}

}  // namespace

PlaneFit fit_to_planes(const Cloud& source, const IcpTarget& target, const SE3& start,
                       const SE3& T_target_source_expected, const PlaneFitConfig& config) {
  PlaneFit fit;
  fit.T_target_source = start;
  std::vector<Pair> pairs(source.size());
  while (!fit.converged && fit.iterations < config.max_iterations) {
    const NormalEquations sums = normal_equations(source, target, fit.T_target_source, config, pairs);
    fit.pairs = sums.pairs;
    if (sums.pairs < config.min_pairs) break;
    fit.degeneracy = detect_degeneracy(sums.H, sums.pairs, config.degeneracy);
    // Unseen directions go to the expected pose, the others to the least squares given that.
    const Vec6 unseen = fit.degeneracy.unseen_part(difference(fit.T_target_source, T_target_source_expected));
    const Vec6 step = unseen + fit.degeneracy.solve(sums.A, sums.b - sums.A * unseen);
    fit.T_target_source = fit.T_target_source * SE3::exp(step);
    ++fit.iterations;
    fit.converged = step.head<3>().norm() <= config.step_rotation_rad &&
                    step.tail<3>().norm() <= config.step_translation_m;
  }
  return fit;
}

}  // namespace vsslam

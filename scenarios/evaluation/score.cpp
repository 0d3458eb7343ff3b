#include "scenarios/evaluation/score.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace vsslam {

namespace {

size_t nearest_stamp(std::span<const StampedPose> trajectory, Time stamp) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& pose, Time t) { return pose.stamp < t; });
  const auto index = static_cast<size_t>(after - trajectory.begin());
  if (index == trajectory.size()) return index - 1;
  // Of two equally near stamps the earlier one counts.
  if (index > 0 && stamp - trajectory[index - 1].stamp <= trajectory[index].stamp - stamp) return index - 1;
  return index;
}

std::vector<Vec3> positions(std::span<const SE3> poses) {
  std::vector<Vec3> result;
  for (const SE3& pose : poses) result.push_back(pose.translation);
  return result;
}

Similarity align(std::span<const SE3> estimate, std::span<const SE3> truth, Alignment alignment) {
  if (alignment == Alignment::none) return {};
  return align_points(positions(estimate), positions(truth), alignment == Alignment::sim3);
}

void score_absolute(std::span<const SE3> estimate, std::span<const SE3> truth, TrajectoryScore& result) {
  double sum = 0, sum_of_squares = 0;
  for (size_t i = 0; i < estimate.size(); ++i) {
    const double error = (estimate[i].translation - truth[i].translation).norm();
    result.errors_m.push_back(error);
    sum += error;
    sum_of_squares += error * error;
    result.ate_max_m = std::max(result.ate_max_m, error);
  }
  const auto count = static_cast<double>(estimate.size());
  result.ate_mean_m = sum / count;
  result.ate_rmse_m = std::sqrt(sum_of_squares / count);
}

/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q truth and P estimate.
SE3 relative_error(const SE3& Q_i, const SE3& Q_j, const SE3& P_i, const SE3& P_j) {
  return (Q_i.inverse() * Q_j).inverse() * (P_i.inverse() * P_j);
}

void score_relative(std::span<const SE3> estimate, std::span<const SE3> truth, const ScoreOptions& options,
                    TrajectoryScore& result) {
  const auto pairs =
      pairs_by_path(positions(options.rpe_pairs_from_truth ? truth : estimate), options.rpe_delta_m,
                    options.rpe_all_pairs, options.rpe_relative_tolerance * options.rpe_delta_m);
  result.rpe_pairs = static_cast<int>(pairs.size());
  if (pairs.empty()) return;
  double translation = 0, rotation = 0;
  for (const auto& [i, j] : pairs) {
    const SE3 error = relative_error(truth[i], truth[j], estimate[i], estimate[j]);
    translation += error.translation.squaredNorm();
    rotation += error.angle() * error.angle();
  }
  const auto count = static_cast<double>(pairs.size());
  result.rpe_10m_percent = 100 * std::sqrt(translation / count) / options.rpe_delta_m;
  result.rpe_10m_deg = std::sqrt(rotation / count) * 180 / std::numbers::pi;
}

double path_length(std::span<const SE3> poses) {
  double length = 0;
  for (size_t i = 1; i < poses.size(); ++i)
    length += (poses[i].translation - poses[i - 1].translation).norm();
  return length;
}

double coverage_of(std::span<const StampedPose> estimate, std::span<const StampPair> matches) {
  constexpr double kTogether_s = 1.0;
  size_t covered = matches.empty() ? 0 : 1;
  for (size_t i = 1; i < matches.size(); ++i) {
    const size_t before = matches[i - 1].estimate, at = matches[i].estimate;
    if (at == before) continue;
    covered += seconds_between(estimate[before].stamp, estimate[at].stamp) <= kTogether_s ? at - before : 1;
  }
  return estimate.empty() ? 0 : static_cast<double>(covered) / static_cast<double>(estimate.size());
}

/// Their extent across the line that fits them best is rounding.
bool on_a_line(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Vec3 extents = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvalues();  // ascending
  return extents[1] <= 1e-12 * extents[2];
}

}  // namespace

std::vector<StampPair> associate(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                                 Duration max_difference) {
  const bool truth_is_longer = truth.size() > estimate.size();
  const auto shorter = truth_is_longer ? estimate : truth;
  const auto longer = truth_is_longer ? truth : estimate;
  std::vector<StampPair> pairs;
  for (size_t i = 0; i < shorter.size(); ++i) {
    const size_t j = nearest_stamp(longer, shorter[i].stamp);
    if (std::max(longer[j].stamp - shorter[i].stamp, shorter[i].stamp - longer[j].stamp) > max_difference)
      continue;
    pairs.push_back(truth_is_longer ? StampPair{i, j} : StampPair{j, i});
  }
  return pairs;
}

std::vector<std::pair<size_t, size_t>> pairs_by_path(std::span<const Vec3> positions, double delta_m,
                                                     bool all_pairs, double tolerance_m) {
  std::vector<double> travelled(positions.size(), 0.0);
  for (size_t i = 1; i < positions.size(); ++i)
    travelled[i] = travelled[i - 1] + (positions[i] - positions[i - 1]).norm();

  std::vector<std::pair<size_t, size_t>> pairs;
  if (all_pairs) {
    for (size_t i = 0; i + 1 < positions.size(); ++i) {
      const double wanted = travelled[i] + delta_m;
      auto at =
          std::lower_bound(travelled.begin() + static_cast<std::ptrdiff_t>(i) + 1, travelled.end(), wanted);
      auto j = std::min(static_cast<size_t>(at - travelled.begin()), positions.size() - 1);
      if (j > i + 1 && wanted - travelled[j - 1] <= std::abs(travelled[j] - wanted)) --j;
      if (std::abs(travelled[j] - wanted) <= tolerance_m) pairs.emplace_back(i, j);
    }
    return pairs;
  }
  // The first pair starts where the first delta_m have been travelled, not at the first pose.
  std::optional<size_t> previous;
  double current_m = 0;
  for (size_t i = 1; i < positions.size(); ++i) {
    current_m += (positions[i] - positions[i - 1]).norm();
    if (current_m < delta_m) continue;
    if (previous) pairs.emplace_back(*previous, i);
    previous = i;
    current_m = 0;
  }
  return pairs;
}

TrajectoryScore score(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                      const ScoreOptions& options, const std::pair<std::string, std::string>& names) {
  TrajectoryScore result;
  if (!estimate.empty() && !truth.empty())
    result.matches = associate(estimate, truth, options.max_time_difference);
  if (result.matches.empty())
    throw InputError(fmt::format("{} and {} have no stamps within {} ms of each other", names.first,
                                 names.second, options.max_time_difference.ns / 1e6));
  result.pairs = static_cast<int>(result.matches.size());
  result.coverage = coverage_of(estimate, result.matches);

  std::vector<SE3> matched_estimate, matched_truth;
  for (const auto& [i, j] : result.matches) {
    matched_estimate.push_back(estimate[i].pose);
    matched_truth.push_back(truth[j].pose);
  }
  result.path_length_m = path_length(matched_truth);
  result.end_error_m = ((matched_estimate.front().inverse() * matched_estimate.back()).translation -
                        (matched_truth.front().inverse() * matched_truth.back()).translation)
                           .norm();

  result.T_truth_estimate = align_poses(matched_estimate, matched_truth);
  result.alignment = align(matched_estimate, matched_truth, options.alignment);
  for (SE3& pose : matched_estimate) pose = result.alignment * pose;
  score_absolute(matched_estimate, matched_truth, result);
  score_relative(matched_estimate, matched_truth, options, result);
  return result;
}

std::string why_alignment_open(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                               const TrajectoryScore& scored) {
  if (scored.pairs < kLeastPairs)
    return fmt::format(
        "{} of {} poses have truth at the same time, and an alignment needs {} that are not on a line",
        scored.pairs, estimate.size(), kLeastPairs);
  std::vector<Vec3> of_estimate, of_truth;
  for (const auto& [i, j] : scored.matches) {
    of_estimate.push_back(estimate[i].pose.translation);
    of_truth.push_back(truth[j].pose.translation);
  }
  const auto open = [&](const char* which) {
    return fmt::format(
        "all {} positions of the {} lie on one line or at one point, which leaves the alignment open",
        scored.pairs, which);
  };
  if (on_a_line(of_truth)) return open("truth");
  return on_a_line(of_estimate) ? open("estimate") : "";
}

}  // namespace vsslam

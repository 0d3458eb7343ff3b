#include "slam/loop/verify_loop.h"

#include "slam/loop/plane_fit.h"

namespace vsslam {

namespace {

Vec3 centroid(const Cloud& cloud) {
  Vec3 sum = Vec3::Zero();
  for (const Eigen::Vector3f& p : cloud) sum += p.cast<double>();
  return sum / static_cast<double>(cloud.size());
}

/// Moves the guess so that the centroids meet, if they are far apart.
SE3 meet(const SE3& T_match_query, const Cloud& source_query, const Cloud& target_match, double far_m) {
  const Vec3 offset = centroid(target_match) - T_match_query * centroid(source_query);
  if (far_m <= 0 || offset.norm() < far_m) return T_match_query;
  return {T_match_query.rotation, T_match_query.translation + offset};
}

/// Of two fits the one from the prediction, unless the other is clearly better.
bool prefers_prediction(const IcpResult& predicted, const IcpResult& other, double ratio) {
  if (!predicted.converged || !other.converged) return predicted.converged;
  return predicted.fitness_m2 <= ratio * other.fitness_m2 && ratio * predicted.overlap >= other.overlap;
}

/// ICP from the guess and, if asked for, from the prediction.
IcpResult fit(const Cloud& source, const IcpTarget& target, const SE3& guess, const SE3& predicted,
              const VerificationConfig& config) {
  const IcpResult first = align(source, target, guess, config.icp, config.overlap_distance_m);
  if (config.prediction_ratio <= 0) return first;
  const IcpResult other = align(source, target, predicted, config.icp, config.overlap_distance_m);
  return prefers_prediction(other, first, config.prediction_ratio) ? other : first;
}

/// Refines a fit where the target has planes; directions that they do not see take the prediction. Nothing without
/// planes.
std::optional<Degeneracy> settle_on_planes(const Cloud& source, const IcpTarget& target, const SE3& predicted,
                                           const VerificationConfig& config, IcpResult& icp) {
  const PlaneFitConfig planes{.max_pair_m = config.overlap_distance_m,
                              .min_pairs = config.min_source_points,
                              .step_translation_m = config.icp.step_translation_m,
                              .step_rotation_rad = config.icp.step_rotation_rad,
                              .degeneracy = {.min_share = config.min_plane_share}};
  const PlaneFit fit = fit_to_planes(source, target, icp.T_target_source, predicted, planes);
  if (fit.iterations == 0) return std::nullopt;
  icp.T_target_source = fit.T_target_source;
  icp.iterations += fit.iterations;
  icp.converged = fit.converged;
  score(source, target, config.icp.max_correspondence_m, config.overlap_distance_m, icp);
  return fit.degeneracy;
}

/// Whether odometry can have drifted as far as the loop says.
bool consistent(const LoopRecord& record, double way_m, const VerificationConfig& config) {
  const SE3 gap = record.T_match_query_predicted.inverse() * record.T_match_query;
  return gap.translation.norm() <= config.allowed_gap_m(way_m) &&
         (config.max_gap_rad <= 0 || gap.angle() <= config.max_gap_rad);
}

std::string verdict(const LoopRecord& record, double way_m, const VerificationConfig& config) {
  if (!record.icp_converged) return "not_converged";
  if (record.fitness_m2 > config.max_fitness_m2) return "fitness";
  if (record.overlap < config.min_overlap) return "overlap";
  if (!consistent(record, way_m, config)) return "gap";
  return "accepted";
}

}  // namespace

void verify_loop(const std::vector<KeyScan>& keys, const SE3& T_base_lidar, const VerificationConfig& config,
                 LocalMaps& maps, LoopRecord& record) {
  const Cloud source_query = features_in_base(keys[static_cast<size_t>(record.query)], T_base_lidar);
  const std::shared_ptr<const IcpTarget> target = maps.around(record.match, record.query, keys);
  if (source_query.size() < static_cast<size_t>(config.min_source_points) ||
      target->points().size() < static_cast<size_t>(config.min_target_points)) {
    record.why = "few_points";
    return;
  }
  const SE3 guess = meet(record.T_match_query, source_query, target->points(), config.centroid_guess_m);
  IcpResult icp = fit(source_query, *target, guess, record.T_match_query_predicted, config);
  if (config.min_plane_share > 0 && icp.converged)
    record.planes = settle_on_planes(source_query, *target, record.T_match_query_predicted, config, icp);
  record.icp_run = true;
  record.icp_converged = icp.converged;
  record.icp_iterations = icp.iterations;
  record.fitness_m2 = icp.fitness_m2;
  record.inlier_ratio = icp.inlier_ratio;
  record.overlap = icp.overlap;
  record.T_match_query = icp.T_target_source;
  const double way_m =
      keys[static_cast<size_t>(record.query)].way_m - keys[static_cast<size_t>(record.match)].way_m;
  record.why = verdict(record, way_m, config);
  record.accepted = record.why == "accepted";
}

}  // namespace vsslam

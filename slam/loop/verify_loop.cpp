#include "slam/loop/verify_loop.h"

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

std::string verdict(const LoopRecord& record, const VerificationConfig& config) {
  if (!record.icp_converged) return "not_converged";
  if (record.fitness_m2 > config.max_fitness_m2) return "fitness";
  if (record.overlap < config.min_overlap) return "overlap";
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
  const IcpResult icp = align(source_query, *target, guess, config.icp, config.overlap_distance_m);
  record.icp_run = true;
  record.icp_converged = icp.converged;
  record.icp_iterations = icp.iterations;
  record.fitness_m2 = icp.fitness_m2;
  record.inlier_ratio = icp.inlier_ratio;
  record.overlap = icp.overlap;
  record.T_match_query = icp.T_target_source;
  record.why = verdict(record, config);
  record.accepted = record.why == "accepted";
}

}  // namespace vsslam

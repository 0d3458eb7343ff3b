#include "scenarios/results/results.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "core/files.h"
#include "scenarios/evaluation/score.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "scenarios/results/map_file.h"
#include "scenarios/results/result_tables.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

constexpr Duration kSameStamp{1'000'000};  // a robot at 1 m/s moves 1 mm, less than an edge is known to

Metrics::Descriptors score_descriptors(const Mapping& mapping) {
  const DatabaseSize size = mapping.loop_closer().database_size(mapping.key_scans());
  return {.count = size.count,
          .index_bytes = static_cast<int64_t>(size.index_bytes),
          .descriptor_bytes = static_cast<int64_t>(size.descriptor_bytes),
          .database_bytes = static_cast<int64_t>(size.database_bytes)};
}

Metrics::Degeneracy score_degeneracy_of(const MappingRun& estimation) {
  std::vector<DegeneracyReport> reports;
  for (const ScanReport& report : estimation.reports())
    reports.push_back({report.information, report.degenerate_directions});
  std::span<const DegeneracyTruth> truth = estimation.degeneracy_truth();
  if (!reports.empty()) reports.erase(reports.begin());  // the first scan has no map to be blind against
  if (!truth.empty()) truth = truth.subspan(1);
  const DegeneracyScore score = score_degeneracy(reports, truth);
  return {score.precision, score.recall, score.direction_error_deg_median};
}

Metrics::Loops score_loops(const RunRecord& record) {
  const LoopScore& score = record.loops;
  return {.candidates = score.candidates,
          .accepted = score.accepted,
          .true_loops = score.true_loops,
          .false_loops = score.false_loops,
          .revisits = static_cast<int64_t>(score.revisits.size()),
          .aliases = record.aliases,
          .recall = score.recall(),
          .precision = score.precision()};
}

// Mean over the edges from key scan to key scan of e' Omega e / 6 (normalised estimation error squared, Bar-Shalom et al.
// 2001, section 5.4).
std::optional<double> odometry_nees(const Mapping& mapping, std::span<const StampedPose> truth) {
  std::vector<StampedPose> keys;
  for (const KeyScan& key : mapping.key_scans()) keys.push_back({key.stamp, key.T_odom_base});
  std::map<int, SE3> true_pose;
  for (const StampPair& pair : associate(keys, truth, kSameStamp))
    true_pose[static_cast<int>(pair.estimate)] = truth[pair.truth].pose;
  double sum = 0, edges = 0;
  for (const PoseEdge& edge : mapping.pose_graph().edges()) {
    const auto from = true_pose.find(edge.from), to = true_pose.find(edge.to);
    if (edge.is_loop || from == true_pose.end() || to == true_pose.end()) continue;
    const Vec6 error = edge_error(edge.T_from_to, from->second, to->second);
    sum += error.dot(edge.information * error) / 6;
    ++edges;
  }
  if (edges == 0) return std::nullopt;
  return sum / edges;
}

void score_trajectories(const RunRecord& record, Metrics& m) {
  const std::span<const StampedPose> truth = record.truth_world_base;
  if (truth.empty()) return;
  const TrajectoryScore estimate = score(record.estimation.mapping().trajectory_map_base(), truth);
  m.coverage = estimate.coverage;
  if (estimate.coverage < kLeastCoverage)
    m.health.warnings.push_back(
        fmt::format("truth: only {:.0f} % of the scans have any: the errors tell of these alone",
                    100 * estimate.coverage));
  if (estimate.pairs < kLeastPairs) {
    m.health.warnings.push_back(
        fmt::format("truth: {} of the scans have any, and an alignment needs {}: no errors are given",
                    estimate.pairs, kLeastPairs));
    return;
  }
  m.path_length_m = estimate.path_length_m;
  m.ate_rmse_m = estimate.ate_rmse_m;
  m.ate_max_m = estimate.ate_max_m;
  m.rpe_10m_percent = estimate.rpe_10m_percent;
  m.rpe_10m_deg = estimate.rpe_10m_deg;
  m.end_error_m = estimate.end_error_m;
  m.odometry_ate_rmse_m = score(record.estimation.mapping().trajectory_odom_base(), truth).ate_rmse_m;
  m.odometry_nees = odometry_nees(record.estimation.mapping(), truth);
  if (!record.estimation.vio_start_base().empty())
    m.vio_ate_rmse_m = score(record.estimation.vio_start_base(), truth).ate_rmse_m;
  const Cloud map = record.estimation.mapping().map_cloud(record.setup.map_voxel_m);
  if (!map.empty() && record.surface != nullptr)
    m.map_error_mean_m = map_error(map, estimate.T_truth_estimate, *record.surface).mean_m;
}

std::vector<StampedPose> shifted(std::span<const StampedPose> trajectory, Duration offset) {
  std::vector<StampedPose> result(trajectory.begin(), trajectory.end());
  for (StampedPose& pose : result) pose.stamp = pose.stamp + offset;
  return result;
}

}  // namespace

Metrics score_run(const RunRecord& record) {
  Metrics m;
  m.scenario = record.name;
  m.method = method_name(record.estimation.method());
  m.seed = record.seed;
  m.truth = record.truth;
  m.failure = record.failure;
  m.health = record.health;
  m.stamp_offset = record.stamp_offset;
  m.duration_s = record.duration_s;
  m.scans = static_cast<int64_t>(record.estimation.reports().size());
  m.images = record.estimation.images();
  m.restarts = record.estimation.restarts();
  score_trajectories(record, m);
  m.descriptors = score_descriptors(record.estimation.mapping());
  m.loops = score_loops(record);
  if (record.truth == Truth::world) m.degeneracy = score_degeneracy_of(record.estimation);
  m.compare(record.bounds);
  return m;
}

void write_results(const fs::path& folder, const RunRecord& record, const Metrics& metrics) {
  const Mapping& mapping = record.estimation.mapping();
  const auto write_trajectory = [&](const char* name, std::span<const StampedPose> trajectory) {
    if (!trajectory.empty()) write_tum(folder / name, shifted(trajectory, record.stamp_offset));
  };
  for (const SavedText& saved : record.saved) write_file(folder / saved.name, saved.text);
  write_file(folder / "metrics.json", metrics.json());
  write_trajectory("truth.tum", record.truth_world_base);
  write_trajectory("estimate.tum", mapping.trajectory_map_base());
  write_trajectory("odometry.tum", mapping.trajectory_odom_base());
  write_trajectory("vio.tum", record.estimation.vio_start_base());
  if (!record.camera_png.empty()) write_file(folder / "camera.png", record.camera_png);
  write_file(folder / "scans.csv", scans_csv(record));
  write_file(folder / "loops.csv", loops_csv(record));
  write_file(folder / "descriptors.csv", descriptors_csv(record));
  const std::string example = record.estimation.descriptor_example().json(
      record.setup.rig.lidar.mount_height_m, record.setup.slam.loop.scan_context);
  if (!example.empty()) write_file(folder / "descriptor_example.json", example);
  mapping.pose_graph().write_g2o(folder / "pose_graph.g2o");
  write_ply(folder / "map.ply", mapping.map_cloud(record.setup.map_voxel_m));
}

void write_timing(const fs::path& folder, const Timing& timing, const WallClock& clock) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const WallClock::StageTimes& s : clock.summary())
    stages[s.stage] = {
        {"median_ms", s.median_ms}, {"p99_ms", s.p99_ms}, {"count", s.count}, {"total_s", s.total_s}};
  const nlohmann::ordered_json json = {{"real_time_factor", timing.real_time_factor},
                                       {"wall_s", timing.wall_s},
                                       {"made_by", timing.made_by},
                                       {"peak_rss_mib", peak_rss_mib()},
                                       {"cores", available_cores()},
                                       {"stages", stages}};
  write_file(folder / "timing.json", json.dump(2) + "\n");
}

}  // namespace vsslam

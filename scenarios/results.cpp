#include "scenarios/results.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "scenarios/evaluation/score.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "scenarios/map_file.h"
#include "scenarios/oracles/aliases.h"
#include "scenarios/result_tables.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

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
  const DegeneracyScore score = score_degeneracy(reports, estimation.degeneracy_truth());
  return {score.precision, score.recall, score.direction_error_deg_median};
}

void score_loops(const RunRecord& record, ScoredRun& scored) {
  scored.loops = record.facts.oracle.score(record.estimation.mapping().loops());
  Metrics::Loops& loops = scored.metrics.loops;
  loops.candidates = scored.loops.candidates;
  loops.accepted = scored.loops.accepted;
  loops.true_loops = scored.loops.true_loops;
  loops.false_loops = scored.loops.false_loops;
  loops.revisits = static_cast<int64_t>(scored.loops.revisits.size());
  loops.recall = scored.loops.recall();
  loops.precision = scored.loops.precision();
  loops.aliases = record.facts.aliases;
}

void score_trajectories(const RunRecord& record, Metrics& m) {
  const std::vector<StampedPose>& truth = record.estimation.truth_world_base();
  if (truth.empty()) return;
  const TrajectoryScore estimate = score(record.estimation.mapping().trajectory_map_base(), truth);
  m.path_length_m = estimate.path_length_m;
  m.ate_rmse_m = estimate.ate_rmse_m;
  m.ate_max_m = estimate.ate_max_m;
  m.rpe_10m_percent = estimate.rpe_10m_percent;
  m.rpe_10m_deg = estimate.rpe_10m_deg;
  m.end_error_m = estimate.end_error_m;
  m.odometry_ate_rmse_m = score(record.estimation.mapping().trajectory_odom_base(), truth).ate_rmse_m;
  if (!record.estimation.vio_start_base().empty())
    m.vio_ate_rmse_m = score(record.estimation.vio_start_base(), truth).ate_rmse_m;
  const Cloud map = record.estimation.mapping().map_cloud(record.scenario.map_voxel_m);
  if (!map.empty()) m.map_error_mean_m = map_error(map, estimate.T_truth_estimate, record.surface).mean_m;
}

}  // namespace

Scenario scenario_of_run(Scenario scenario, Method method, uint64_t seed) {
  scenario.methods = {std::string(method_name(method))};
  scenario.seeds = {seed};
  return scenario;
}

// An alias is nearer than the threshold of `vs-slam`, whatever the method of the run: it tells of the world.
SeedFacts seed_facts(const Scenario& scenario, const World& world, const Raycaster& raycaster,
                     const OdometryRun& odometry) {
  LoopOracle oracle(world, raycaster, odometry.key_scan_truth());
  const auto aliases =
      find_aliases(oracle, odometry.true_descriptors(), scenario.slam.loop.vs_slam.max_distance).size();
  return {std::move(oracle), static_cast<int64_t>(aliases), odometry.pictures().png()};
}

ScoredRun score_run(const RunRecord& record) {
  ScoredRun scored;
  Metrics& m = scored.metrics;
  m.scenario = record.scenario.name;
  m.method = method_name(record.estimation.method());
  m.seed = record.seed;
  m.failure = record.failure;
  m.duration_s = record.duration_s;
  m.scans = static_cast<int64_t>(record.estimation.reports().size());
  m.images = record.estimation.images();
  m.restarts = record.estimation.restarts();
  score_trajectories(record, m);
  m.descriptors = score_descriptors(record.estimation.mapping());
  score_loops(record, scored);
  m.degeneracy = score_degeneracy_of(record.estimation);
  m.compare(bounds_for(record.scenario.expect, m.method));
  return scored;
}

void write_results(const fs::path& folder, const RunRecord& record, const ScoredRun& scored) {
  const Mapping& mapping = record.estimation.mapping();
  write_file(folder / "scenario.yaml",
             save_config(scenario_of_run(record.scenario, record.estimation.method(), record.seed)));
  write_file(folder / "metrics.json", scored.metrics.json());
  write_tum(folder / "truth.tum", record.estimation.truth_world_base());
  write_tum(folder / "estimate.tum", mapping.trajectory_map_base());
  write_tum(folder / "odometry.tum", mapping.trajectory_odom_base());
  if (!record.estimation.vio_start_base().empty())
    write_tum(folder / "vio.tum", record.estimation.vio_start_base());
  if (!record.facts.camera_png.empty()) write_file(folder / "camera.png", record.facts.camera_png);
  write_file(folder / "scans.csv", scans_csv(record.estimation, scored.loops));
  write_file(folder / "loops.csv", loops_csv(mapping.loops(), scored.loops));
  write_file(folder / "descriptors.csv", descriptors_csv(mapping));
  const std::string example = record.estimation.descriptor_example().json(
      calibration_of(record.scenario).lidar.mount_height_m, record.scenario.slam.loop.scan_context);
  if (!example.empty()) write_file(folder / "descriptor_example.json", example);
  mapping.pose_graph().write_g2o(folder / "pose_graph.g2o");
  write_ply(folder / "map.ply", mapping.map_cloud(record.scenario.map_voxel_m));
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

fs::path result_path(const fs::path& out, const std::string& scenario, Method method, uint64_t seed) {
  return out / scenario / method_name(method) / fmt::format("seed_{}", seed);
}

}  // namespace vsslam

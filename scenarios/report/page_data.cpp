#include "scenarios/report/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "core/errors.h"
#include "scenarios/evaluation/score.h"
#include "scenarios/report/page_json.h"

namespace vsslam {

namespace {

using nlohmann::json;

constexpr size_t kPoses = 4000, kScans = 3000, kMapPoints = 60'000;  // of a page with one result
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// The truth, or without it the estimate, with the path length travelled at each pose, found by stamp.
class Path {
 public:
  explicit Path(const PoseTrajectory& truth) : truth_(truth), travelled_m_(truth.size(), 0.0) {
    for (size_t i = 1; i < truth.size(); ++i)
      travelled_m_[i] =
          travelled_m_[i - 1] + (truth[i].pose.translation - truth[i - 1].pose.translation).norm();
  }
  size_t nearest(Time stamp) const {
    const auto after = std::lower_bound(truth_.begin(), truth_.end(), stamp,
                                        [](const StampedPose& pose, Time t) { return pose.stamp < t; });
    const auto index = static_cast<size_t>(after - truth_.begin());
    if (index == truth_.size()) return index - 1;
    if (index > 0 && stamp - truth_[index - 1].stamp <= truth_[index].stamp - stamp) return index - 1;
    return index;
  }
  double time_s(Time stamp) const { return seconds_between(truth_.front().stamp, stamp); }
  double travelled_m(Time stamp) const { return travelled_m_[nearest(stamp)]; }
  const SE3& T_world_base(Time stamp) const { return truth_[nearest(stamp)].pose; }

 private:
  const PoseTrajectory& truth_;
  std::vector<double> travelled_m_;
};

json truth_json(const PoseTrajectory& truth, size_t most) {
  Series series;
  const size_t stride = stride_for(truth.size(), most);
  for (size_t i = 0; i < truth.size(); i += stride) {
    series.add("x", truth[i].pose.translation.x());
    series.add("y", truth[i].pose.translation.y());
  }
  return series.to_json();
}

/// A trajectory aligned to the truth, with its error over time and over the path.
json estimate_json(const PoseTrajectory& estimate, const PoseTrajectory& truth, const Path& path,
                   const TrajectoryScore& scored, size_t most) {
  Series series;
  const size_t stride = stride_for(scored.matches.size(), most);
  for (size_t k = 0; k < scored.matches.size(); k += stride) {
    const auto& [i, j] = scored.matches[k];
    const SE3 T_world_base = scored.alignment * estimate[i].pose;
    series.add("t", path.time_s(truth[j].stamp));
    series.add("d", path.travelled_m(truth[j].stamp));
    series.add("x", T_world_base.translation.x());
    series.add("y", T_world_base.translation.y());
    series.add("error_m", scored.errors_m[k]);
    series.add("error_deg", (truth[j].pose.inverse() * T_world_base).angle() * 180 / std::numbers::pi);
  }
  return series.to_json();
}

/// A trajectory that there is no truth for, as it is.
json plain_json(const PoseTrajectory& trajectory, const Path& path, size_t most) {
  Series series;
  const size_t stride = stride_for(trajectory.size(), most);
  for (size_t i = 0; i < trajectory.size(); i += stride) {
    series.add("t", path.time_s(trajectory[i].stamp));
    series.add("d", path.travelled_m(trajectory[i].stamp));
    series.add("x", trajectory[i].pose.translation.x());
    series.add("y", trajectory[i].pose.translation.y());
  }
  return series.to_json();
}

/// Points in the world frame as 16-bit steps from a corner.
json map_json(const Cloud& points_map, const SE3& T_world_map, size_t most) {
  const size_t stride = stride_for(points_map.size(), most);
  std::vector<Vec3> points_world;
  Eigen::AlignedBox3d box;
  for (size_t i = 0; i < points_map.size(); i += stride) {
    points_world.push_back(T_world_map * points_map[i].cast<double>());
    box.extend(points_world.back());
  }
  if (points_world.empty()) return nullptr;
  const double step_m = std::max(1e-3, box.sizes().maxCoeff() / 65000);
  std::vector<uint16_t> steps;
  steps.reserve(3 * points_world.size());
  for (const Vec3& p : points_world)
    for (int axis = 0; axis < 3; ++axis)
      steps.push_back(static_cast<uint16_t>(std::lround((p[axis] - box.min()[axis]) / step_m)));
  return {{"origin", {box.min().x(), box.min().y(), box.min().z()}},
          {"step_m", step_m},
          {"xyz", base64_array(steps)}};
}

Time stamp_of(const CsvTable& table, const StoredResult& result, const char* file, size_t row,
              const char* column) {
  const auto stamp = parse_seconds(table.text(row, column));
  if (!stamp)
    throw InputError(fmt::format("{}: row {}: column \"{}\": expected seconds", (result.path / file).string(),
                                 row + 1, column));
  return *stamp;
}

double maybe(const CsvTable& table, size_t row, const std::string& column) {
  return table.maybe_number(row, column).value_or(kNone);
}

Vec3 vector_of(const CsvTable& table, size_t row, const std::string& prefix) {
  return {maybe(table, row, prefix + "_x"), maybe(table, row, prefix + "_y"),
          maybe(table, row, prefix + "_z")};
}

double angle_between_deg(const Vec3& a, const Vec3& b) {
  const double cosine = std::abs(a.dot(b)) / (a.norm() * b.norm());
  return std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi;
}

/// Eigenvalues are divided by the number of points behind them, so that the estimator's and the true ones
/// compare.
void add_eigenvalues(Series& series, const CsvTable& scans, size_t row, const std::string& prefix,
                     double points) {
  for (const char* block : {"t", "r"})
    for (const char* index : {"_0", "_1", "_2"}) {
      const std::string name = prefix + "eigen_" + block + index;
      series.add(name, points > 0 ? maybe(scans, row, name) / points : kNone);
    }
}

json scans_json(const StoredResult& result, const Path& path, size_t most) {
  const CsvTable& scans = *result.scans;
  Series series;
  const size_t stride = stride_for(scans.rows(), most);
  for (size_t row = 0; row < scans.rows(); row += stride) {
    const Time stamp = stamp_of(scans, result, "scans.csv", row, "stamp");
    series.add("t", path.time_s(stamp));
    series.add("d", path.travelled_m(stamp));
    for (const char* column : {"s", "alpha_t", "alpha_r", "true_alpha_t", "true_alpha_r",
                               "degenerate_directions", "true_degenerate_directions"})
      series.add(column, maybe(scans, row, column));
    add_eigenvalues(series, scans, row, "", maybe(scans, row, "correspondences"));
    add_eigenvalues(series, scans, row, "true_", maybe(scans, row, "true_points"));
    for (const std::string block : {"t", "r"})
      series.add("weak_angle_" + block + "_deg",
                 angle_between_deg(vector_of(scans, row, "weak_" + block),
                                   vector_of(scans, row, "true_weak_" + block)));
  }
  return series.to_json();
}

/// Directions that the scan did not hold, at key scans, seen from above. A level LiDAR that looks ahead is
/// assumed.
json weak_json(const StoredResult& result, const Path& path) {
  const CsvTable& scans = *result.scans;
  Series series;
  for (size_t row = 0; row < scans.rows(); ++row) {
    const double degenerate = maybe(scans, row, "degenerate_directions");
    if (scans.empty(row, "key") || scans.integer(row, "key") < 0 || !(degenerate > 0)) continue;
    const SE3& T_world_base = path.T_world_base(stamp_of(scans, result, "scans.csv", row, "stamp"));
    const Vec3 direction_world = T_world_base.rotation * vector_of(scans, row, "weak_t");
    if (!direction_world.allFinite()) continue;
    series.add("x", T_world_base.translation.x());
    series.add("y", T_world_base.translation.y());
    series.add("dx", direction_world.x());
    series.add("dy", direction_world.y());
  }
  return series.to_json();
}

json place(const SE3& T_world_base) {
  return {T_world_base.translation.x(), T_world_base.translation.y()};
}

/// Accepted edges and missed revisits as lines between true places, without truth between estimated ones.
json loops_json(const StoredResult& result, const Path& path) {
  json lines = json::array();
  const CsvTable& loops = *result.loops;
  for (size_t row = 0; row < loops.rows(); ++row) {
    const std::string& judged = loops.text(row, "verdict");
    const std::string verdict = judged.empty() ? "accepted" : judged;
    const SE3& query = path.T_world_base(stamp_of(loops, result, "loops.csv", row, "query_stamp"));
    const SE3& match = path.T_world_base(stamp_of(loops, result, "loops.csv", row, "match_stamp"));
    lines.push_back({{"kind", verdict},
                     {"row", row},
                     {"from", place(query)},
                     {"to", place(match)},
                     {"label", fmt::format("{} loop {} → {}: {}", verdict, loops.text(row, "query"),
                                           loops.text(row, "match"), loops.text(row, "why"))}});
  }
  return lines;
}

json missed_json(const StoredResult& result, const Path& path) {
  const CsvTable& scans = *result.scans;
  std::map<int64_t, Time> stamps;
  json lines = json::array();
  for (size_t row = 0; row < scans.rows(); ++row) {
    if (scans.empty(row, "key") || scans.integer(row, "key") < 0) continue;
    const int64_t key = scans.integer(row, "key");
    const Time stamp = stamps[key] = stamp_of(scans, result, "scans.csv", row, "stamp");
    if (scans.empty(row, "revisit_of") || scans.integer(row, "revisit_closed") != 0) continue;
    const int64_t of = scans.integer(row, "revisit_of");
    if (!stamps.contains(of))
      throw InputError(fmt::format("{}: row {}: revisit_of {} is no earlier key scan",
                                   (result.path / "scans.csv").string(), row + 1, of));
    lines.push_back({{"kind", "missed"},
                     {"from", place(path.T_world_base(stamp))},
                     {"to", place(path.T_world_base(stamps[of]))},
                     {"label", fmt::format("missed: {} shows {} again", key, of)}});
  }
  return lines;
}

json stored_json(const StoredResult& result, const Path& path) {
  const CsvTable& stored = *result.descriptors;
  Series series;
  for (size_t row = 0; row < stored.rows(); ++row) {
    const SE3& T_world_base = path.T_world_base(stamp_of(stored, result, "descriptors.csv", row, "stamp"));
    series.add("x", T_world_base.translation.x());
    series.add("y", T_world_base.translation.y());
  }
  return series.to_json();
}

void add_trajectories(json& run, const StoredResult& result, const Path& path, size_t results) {
  const size_t most = kPoses / results;
  if (!result.has_truth()) {
    run["estimate"] = plain_json(result.estimate, path, most);
    if (!result.odometry.empty()) run["odometry"] = plain_json(result.odometry, path, most);
    if (result.points_map) run["map"] = map_json(*result.points_map, SE3(), kMapPoints / results);
    return;
  }
  const std::string truth_name = (result.path / "truth.tum").string();
  const auto scored = [&](const PoseTrajectory& trajectory, const char* file) {
    return score(trajectory, result.truth, {}, {(result.path / file).string(), truth_name});
  };
  const TrajectoryScore estimate = scored(result.estimate, "estimate.tum");
  run["truth"] = truth_json(result.truth, most);
  run["estimate"] = estimate_json(result.estimate, result.truth, path, estimate, most);
  if (!result.odometry.empty())
    run["odometry"] =
        estimate_json(result.odometry, result.truth, path, scored(result.odometry, "odometry.tum"), most);
  if (result.points_map)
    run["map"] = map_json(*result.points_map, estimate.T_truth_estimate, kMapPoints / results);
}

json result_json(const StoredResult& result, size_t results) {
  const Path path(result.has_truth() ? result.truth : result.estimate);
  json run = {{"name", result.name()}, {"scenario", result.scenario}};
  add_trajectories(run, result, path, results);
  if (result.scans && result.scans->rows() > 0) {
    run["scans"] = scans_json(result, path, kScans / results);
    run["weak"] = weak_json(result, path);
    run["missed"] = missed_json(result, path);
  }
  if (result.loops) run["loops"] = loops_json(result, path);
  if (result.descriptors && result.descriptors->rows() > 0) run["stored"] = stored_json(result, path);
  return run;
}

}  // namespace

std::string page_data(std::span<const StoredResult> results) {
  json runs = json::array();
  for (const StoredResult& result : results) runs.push_back(result_json(result, results.size()));
  return script_text({{"runs", runs}});
}

}  // namespace vsslam

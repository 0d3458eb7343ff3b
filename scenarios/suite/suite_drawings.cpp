#include "scenarios/suite/suite_drawings.h"

#include <cmath>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/score.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "scenarios/report/page_json.h"
#include "scenarios/report/ply_points.h"

namespace vsslam {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr size_t kPoses = 700, kMapPoints = 7000;  // of a scenario

/// A whole result's trajectories in the world frame.
struct Drawn {
  PoseTrajectory truth, estimate;
  TrajectoryScore scored;
};

Drawn read_drawn(const fs::path& folder) {
  Drawn drawn{read_tum(folder / "truth.tum"), read_tum(folder / "estimate.tum"), {}};
  drawn.scored = score(drawn.estimate, drawn.truth, {},
                       {(folder / "estimate.tum").string(), (folder / "truth.tum").string()});
  return drawn;
}

void add_place(Series& series, const Vec3& position_world) {
  series.add("x", position_world.x());
  series.add("y", position_world.y());
}

json truth_json(const Drawn& drawn) {
  Series series;
  for (size_t i = 0; i < drawn.truth.size(); i += stride_for(drawn.truth.size(), kPoses))
    add_place(series, drawn.truth[i].pose.translation);
  return series.to_json();
}

json estimate_json(const Drawn& drawn) {
  Series series;
  for (size_t i = 0; i < drawn.estimate.size(); i += stride_for(drawn.estimate.size(), kPoses))
    add_place(series, (drawn.scored.alignment * drawn.estimate[i].pose).translation);
  return series.to_json();
}

/// Points of the map from above, as 16-bit steps from a corner.
json map_json(const Cloud& points_map, const SE3& T_world_map) {
  Eigen::AlignedBox2d box;
  std::vector<Eigen::Vector2d> points_world;
  for (size_t i = 0; i < points_map.size(); i += stride_for(points_map.size(), kMapPoints)) {
    points_world.push_back((T_world_map * points_map[i].cast<double>()).head<2>());
    box.extend(points_world.back());
  }
  if (points_world.empty()) return nullptr;
  const double step_m = std::max(1e-3, box.sizes().maxCoeff() / 65000);
  std::vector<uint16_t> steps;
  for (const Eigen::Vector2d& p : points_world)
    for (int axis = 0; axis < 2; ++axis)
      steps.push_back(static_cast<uint16_t>(std::lround((p[axis] - box.min()[axis]) / step_m)));
  return {{"origin", {box.min().x(), box.min().y()}}, {"step_m", step_m}, {"xy", base64_array(steps)}};
}

/// Key scans of a method that selects: where they are, and what was decided.
json keys_json(const fs::path& folder, const Drawn& drawn) {
  const CsvTable scans = CsvTable::read(folder / "scans.csv");
  if (scans.rows() != drawn.estimate.size())
    throw InputError((folder / "scans.csv").string() + ": not one row for each pose of estimate.tum");
  Series series;
  size_t keys = 0;
  for (size_t row = 0; row < scans.rows(); ++row) {
    if (scans.integer(row, "key") < 0 || scans.empty(row, "tau")) continue;
    const SE3 T_world_base = drawn.scored.alignment * drawn.estimate[row].pose;
    add_place(series, T_world_base.translation);
    series.add("yaw", T_world_base.rpy().z());
    series.add("s", scans.number(row, "s"));
    series.add("tau", scans.number(row, "tau"));
    ++keys;
  }
  return keys == 0 ? json() : series.to_json();
}

json example_json(const fs::path& file) {
  if (!fs::exists(file)) return nullptr;
  try {
    json example = json::parse(read_file(file));
    for (json& scan : example.at("scans"))
      for (const char* part : {"heights_cm", "points_lidar_cm"})
        scan[part] = base64_array(scan.at(part).get<std::vector<int16_t>>());
    return example;
  } catch (const json::exception& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

const RunFigures* first_result(const SuiteFigures& figures, size_t scenario, Method method) {
  for (const RunFigures& r : figures.runs())
    if (r.present && r.run.scenario == scenario && r.run.method == method) return &r;
  return nullptr;
}

json scenario_json(const SuiteFigures& figures, size_t scenario) {
  json drawing = {{"name", figures.plan().scenarios[scenario].name}, {"estimates", json::array()}};
  const Method focus = parse_method(figures.plan().suite.focus);
  for (const Method method : figures.plan().methods) {
    const RunFigures* result = first_result(figures, scenario, method);
    if (result == nullptr) continue;
    const fs::path& folder = result->run.folder;
    const Drawn drawn = read_drawn(folder);
    if (!drawing.contains("truth")) {
      drawing["truth"] = truth_json(drawn);
      drawing["seed"] = result->run.seed;
    }
    json estimate = estimate_json(drawn);
    estimate["method"] = method_name(method);
    drawing["estimates"].push_back(std::move(estimate));
    if (method != focus) continue;
    drawing["map"] = map_json(read_ply_points(folder / "map.ply"), drawn.scored.alignment.T_truth_estimate);
    drawing["keys"] = keys_json(folder, drawn);
    drawing["example"] = example_json(folder / "descriptor_example.json");
  }
  return drawing;
}

json bars_json(const SuiteFigures& figures) {
  json bars = json::array();
  const SuitePlan& plan = figures.plan();
  for (const char* metric :
       {"descriptors.index_bytes", "descriptors.descriptor_bytes", "descriptors.database_bytes"}) {
    json rows = json::array();
    for (size_t i = 0; i < plan.scenarios.size(); ++i)
      for (const Method method : plan.methods) {
        const auto spread = figures.over_seeds(i, method, metric);
        const std::string name(method_name(method));
        const auto reference = plan.suite.reference.find(plan.scenarios[i].name, name, metric);
        if (!spread || spread->high <= 24) continue;  // 24 bytes: an empty index
        rows.push_back({{"scenario", plan.scenarios[i].name}, {"method", name}, {"value", spread->mean}});
        if (reference) rows.back()["reference"] = *reference;
      }
    if (!rows.empty()) bars.push_back({{"metric", metric}, {"rows", rows}});
  }
  return bars;
}

json offsets_json(const std::vector<MethodOffsets>& offsets) {
  json list = json::array();
  for (const MethodOffsets& of : offsets) {
    json one = {{"method", method_name(of.method)}, {"offset_m", json::array()}, {"recall", json::array()}};
    for (const OffsetBin& bin : of.bins) {
      if (bin.revisits == 0) continue;
      one["offset_m"].push_back((bin.low_m + bin.high_m) / 2);
      one["recall"].push_back(static_cast<double>(bin.closed) / bin.revisits);
    }
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace

std::string suite_drawings(const SuiteFigures& figures, const std::vector<MethodOffsets>& offsets) {
  json scenarios = json::array(), methods = json::array();
  for (size_t i = 0; i < figures.plan().scenarios.size(); ++i) scenarios.push_back(scenario_json(figures, i));
  std::erase_if(scenarios.get_ref<json::array_t&>(), [](const json& s) { return !s.contains("truth"); });
  for (const Method method : figures.plan().methods) methods.push_back(method_name(method));
  return script_text({{"methods", methods},
                      {"focus", figures.plan().suite.focus},
                      {"scenarios", scenarios},
                      {"bars", bars_json(figures)},
                      {"offsets", offsets_json(offsets)}});
}

}  // namespace vsslam

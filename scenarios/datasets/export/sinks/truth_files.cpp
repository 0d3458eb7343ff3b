#include "scenarios/datasets/export/sinks/truth_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/errors.h"
#include "core/files.h"
#include "core/suggestion.h"
#include "scenarios/datasets/export/sinks/image_truth_sink.h"
#include "scenarios/datasets/export/sinks/point_truth_sink.h"
#include "scenarios/datasets/export/sinks/truth_tables.h"
#include "scenarios/datasets/formats/cloud_files.h"
#include "scenarios/evaluation/csv.h"

namespace vsslam {

namespace {

constexpr std::array<std::pair<TruthKind, const char*>, 7> kKinds = {{{TruthKind::points, "points"},
                                                                      {TruthKind::clean, "clean"},
                                                                      {TruthKind::depth, "depth"},
                                                                      {TruthKind::labels, "labels"},
                                                                      {TruthKind::biases, "biases"},
                                                                      {TruthKind::loops, "loops"},
                                                                      {TruthKind::degeneracy, "degeneracy"}}};

// Names of what the labels' numbers stand for.
std::string label_names(const World& world) {
  constexpr std::array kColumns = {"kind", "id", "name"};
  CsvWriter csv(kColumns);
  for (size_t i = 0; i < world.objects.size(); ++i) csv("object")(i)(world.objects[i].name).end_row();
  for (size_t i = 0; i < world.materials.size(); ++i) csv("material")(i)(world.materials[i].name).end_row();
  return csv.text();
}

std::string description(TruthKind kind, bool camera) {
  const char* const images = ", `truth/clean_images/<ns>.png`: each image without blur and noise";
  switch (kind) {
    case TruthKind::points:
      return "`truth/points/%06d.pcd`: of each point, in the scan's order: x y z (m) and normal, noise-free "
             "and "
             "undistorted, in the LiDAR frame at the scan's stamp; range (m) and cosine of the incidence; "
             "index of "
             "object, triangle and material";
    case TruthKind::clean:
      return fmt::format(
          "`truth/clean/%06d.pcd`: x y z (m) of each point, noise-free and undistorted, in the LiDAR frame "
          "at the "
          "scan's stamp{}",
          camera ? images : "");
    case TruthKind::depth:
      return "`truth/depth/<ns>.png`: depth along the camera's z in mm, 16 bits; 0: nothing within 65.5 m";
    case TruthKind::labels:
      return "`truth/labels/%06d.label`: of each point a uint32, material in the lower 16 bits, object in "
             "the upper; "
             "`truth/label_names.csv` names them";
    case TruthKind::biases:
      return "`truth/imu.csv`: biases (rad/s, m/s^2) and noise-free rates of each IMU sample; "
             "`truth/wheels.csv`: slip "
             "of the left and right wheels (m/s)";
    case TruthKind::loops:
      return fmt::format(
          "`truth/key_scans.csv`: the first scan and then one every {} m of driven way, pose of the base in "
          "the world; "
          "`truth/loops.csv`: pairs of them at least 30 s apart and within {} m, with the base of the query "
          "in the "
          "base of the match, the overlap (share of the query's points that the match sees) and whether that "
          "is a "
          "revisit (within 4 m, overlap at least 0.3)",
          LoopSink::kKeyStep_m, LoopSink::kLoopWithin_m);
    case TruthKind::degeneracy:
      return "`truth/degeneracy.csv`: per scan the eigenvalues of the information of its noise-free points "
             "about its "
             "translation (t) and rotation (r), ascending, with the weakest direction in the LiDAR frame, "
             "and how many "
             "directions are degenerate";
  }
  return {};
}

}  // namespace

std::vector<std::string> truth_names() {
  std::vector<std::string> names;
  for (const auto& [kind, name] : kKinds) names.emplace_back(name);
  return names;
}

TruthKind parse_truth(std::string_view name) {
  for (const auto& [kind, known] : kKinds)
    if (known == name) return kind;
  std::vector<std::string> names = truth_names();
  names.insert(names.begin(), "camera");
  throw InputError(fmt::format("--with: unknown extra \"{}\" ({})", name, suggestion(name, names)));
}

std::vector<std::unique_ptr<DatasetSink>> truth_sinks(const DatasetFacts& facts, const World& world,
                                                      const std::vector<TruthKind>& kinds) {
  const std::filesystem::path folder = facts.folder / "truth";
  std::vector<std::unique_ptr<DatasetSink>> sinks;
  const auto points = [&](const char* name, const char* ending, PointTruthSink::Encoder encode) {
    sinks.push_back(std::make_unique<PointTruthSink>(folder / name, ending, std::move(encode)));
  };
  const auto wants = [&](TruthKind kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  if (wants(TruthKind::points)) points("points", "pcd", pcd_of_truth);
  if (wants(TruthKind::clean)) points("clean", "pcd", pcd_of_twins);
  if (wants(TruthKind::labels)) {
    points("labels", "label", labels_of);
    write_file(folder / "label_names.csv", label_names(world));
  }
  if (facts.has_camera() && wants(TruthKind::clean))
    sinks.push_back(std::make_unique<ImageTruthSink>(facts, ImageTruthSink::Kind::clean));
  if (facts.has_camera() && wants(TruthKind::depth))
    sinks.push_back(std::make_unique<ImageTruthSink>(facts, ImageTruthSink::Kind::depth));
  if (wants(TruthKind::biases)) sinks.push_back(std::make_unique<BiasSink>(facts));
  if (wants(TruthKind::degeneracy)) sinks.push_back(std::make_unique<DegeneracySink>(facts));
  if (wants(TruthKind::loops)) sinks.push_back(std::make_unique<LoopSink>(facts, world));
  return sinks;
}

std::string truth_description(const std::vector<TruthKind>& kinds, bool camera) {
  std::string text;
  for (const TruthKind kind : kinds) text += fmt::format("* {}\n", description(kind, camera));
  return text;
}

}  // namespace vsslam

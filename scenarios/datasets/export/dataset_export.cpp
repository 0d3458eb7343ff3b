#include "scenarios/datasets/export/dataset_export.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/cli/cli.h"
#include "scenarios/datasets/export/dataset_folder.h"
#include "scenarios/datasets/export/dataset_readme.h"
#include "scenarios/datasets/export/sinks/cloud_folder_sink.h"
#include "scenarios/datasets/export/sinks/euroc_sink.h"
#include "scenarios/datasets/export/sinks/kitti_sink.h"
#include "scenarios/datasets/export/sinks/message_sink.h"
#include "scenarios/datasets/export/sinks/truth_trajectory_sink.h"
#include "scenarios/datasets/export/sinks/tum_sink.h"
#include "scenarios/datasets/facts/rig_sheet.h"
#include "scenarios/experiment/fingerprint.h"
#include "scenarios/stages/estimation.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

std::vector<DatasetFormat> formats_of(const ExportRequest& request, const TargetSystem* system) {
  if (request.formats.empty()) return {system != nullptr ? system->format : DatasetFormat::bag};
  std::vector<DatasetFormat> formats;
  for (const std::string& name : split_list(request.formats)) {
    const DatasetFormat format = parse_format(name);
    if (std::find(formats.begin(), formats.end(), format) == formats.end()) formats.push_back(format);
  }
  return formats;
}

/// What --with says. "camera" is no truth but a sensor.
struct Extras {
  std::vector<TruthKind> truth;
  bool camera = false;
};

Extras extras_of(const std::string& with) {
  Extras extras;
  if (with.empty()) return extras;
  for (const std::string& name : split_list(with)) {
    if (name == "camera")
      extras.camera = true;
    else if (const TruthKind kind = parse_truth(name);
             std::find(extras.truth.begin(), extras.truth.end(), kind) == extras.truth.end())
      extras.truth.push_back(kind);
  }
  return extras;
}

bool asked(const Extras& extras, TruthKind kind) {
  return std::find(extras.truth.begin(), extras.truth.end(), kind) != extras.truth.end();
}

// A camera costs most of the time: it is there if the system needs it, was asked for, or, without a system, if the
// scenario has one.
void decide_camera(ExportPlan& plan, const Extras& extras) {
  CameraConfig& camera = plan.facts.scenario.rig.sensors.camera;
  const bool was_enabled = camera.enabled;
  camera.enabled = extras.camera || asked(extras, TruthKind::depth) ||
                   (plan.system != nullptr ? plan.system->camera : was_enabled);
  camera.truth = {};
  if (camera.enabled)
    camera.truth = {
        .clean = asked(extras, TruthKind::clean), .depth = asked(extras, TruthKind::depth), .flow = false};
  if (camera.enabled && !was_enabled)
    plan.notes.push_back(plan.system != nullptr && plan.system->camera
                             ? fmt::format("{} needs a camera: it is enabled", plan.system->title)
                             : std::string("the camera is enabled"));
  if (!camera.enabled && was_enabled)
    plan.notes.push_back(
        fmt::format("{} uses no camera: it is left out (--with camera keeps it)", plan.system->title));
}

void decide_orientation(ExportPlan& plan) {
  bool& orientation = plan.facts.scenario.rig.sensors.imu.orientation;
  if (plan.system == nullptr || !plan.system->orientation || orientation) return;
  orientation = true;
  plan.notes.push_back(fmt::format("{} needs the IMU's orientation: it is enabled", plan.system->title));
}

void decide_imu_mount(ExportPlan& plan) {
  if (plan.system == nullptr || !plan.system->imu_rpy_deg) return;
  Vec3& rpy_deg = plan.facts.scenario.rig.mounts.imu.rpy_deg;
  if (rpy_deg == *plan.system->imu_rpy_deg) return;
  rpy_deg = *plan.system->imu_rpy_deg;
  plan.notes.push_back(fmt::format("{} works with one mount of the IMU only: rpy_deg is [{}, {}, {}]",
                                   plan.system->title, rpy_deg.x(), rpy_deg.y(), rpy_deg.z()));
}

bool has_messages(const ExportPlan& plan) {
  return plan.has(DatasetFormat::bag) || plan.has(DatasetFormat::mcap);
}

// What the begun or finished export in a folder must agree with.
std::string key_of(const ExportPlan& plan) {
  std::string key = fmt::format("system: {}\nformats:", plan.system != nullptr ? plan.system->name : "");
  for (const DatasetFormat format : plan.formats) key += fmt::format(" {}", format_name(format));
  key += "\ntruth:";
  for (const TruthKind kind : plan.truth) key += fmt::format(" {}", static_cast<int>(kind));
  return key + fmt::format("\nmade_by: {}\n", fingerprint(plan.facts.scenario)) +
         save_config(plan.facts.scenario);
}

std::vector<std::unique_ptr<DatasetSink>> sinks_of(const ExportPlan& plan, const World& world) {
  const DatasetFacts& facts = plan.facts;
  std::vector<std::unique_ptr<DatasetSink>> sinks;
  const auto add = [&](auto sink) { sinks.push_back(std::move(sink)); };
  const fs::path file = facts.folder / facts.scenario.name;
  for (const DatasetFormat format : plan.formats) switch (format) {
      case DatasetFormat::bag:
        add(std::make_unique<MessageSink>(facts, write_bag(file.string() + ".bag")));
        break;
      case DatasetFormat::mcap:
        add(std::make_unique<MessageSink>(facts, write_mcap(file.string() + ".mcap")));
        break;
      case DatasetFormat::euroc:
        add(std::make_unique<EurocSink>(facts));
        break;
      case DatasetFormat::kitti:
        add(std::make_unique<KittiSink>(facts));
        break;
      case DatasetFormat::pcd:
        add(std::make_unique<CloudFolderSink>(facts, CloudFolderSink::Format::pcd));
        break;
      case DatasetFormat::ply:
        add(std::make_unique<CloudFolderSink>(facts, CloudFolderSink::Format::ply));
        break;
      case DatasetFormat::tum:
        add(std::make_unique<TumSink>(facts));
        break;
    }
  add(std::make_unique<TruthTrajectorySink>(facts));
  for (auto& sink : truth_sinks(facts, world, plan.truth)) add(std::move(sink));
  return sinks;
}

RigSheet sheet_of(const ExportPlan& plan) {
  RigSheet sheet{.calibration = plan.facts.rig, .topics = {}};
  const MessageNames& names = plan.facts.names;
  if (has_messages(plan))
    sheet.topics = {.lidar = names.points,
                    .imu = names.imu,
                    .camera = plan.facts.has_camera() ? names.image : "",
                    .wheels = names.joints,
                    .truth = names.truth};
  return sheet;
}

void describe(const ExportPlan& plan, const DatasetCounts& counts) {
  const fs::path& folder = plan.facts.folder;
  write_file(folder / "scenario.yaml", save_config(plan.facts.scenario));
  write_file(folder / "rig.yaml",
             "# The rig of this dataset. T_base_sensor maps sensor coordinates to base coordinates.\n" +
                 save_config(sheet_of(plan)));
  if (plan.system != nullptr)
    for (const ExtraFile& file : plan.system->configuration(plan.facts))
      write_file(folder / file.path, file.content);
  write_file(folder / "README.md", dataset_readme(plan, counts));
}

}  // namespace

bool ExportPlan::has(DatasetFormat format) const {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

ExportPlan plan_export(const ExportRequest& request) {
  ExportPlan plan;
  if (!request.system.empty()) plan.system = &target_system(request.system);
  plan.formats = formats_of(request, plan.system);
  const Extras extras = extras_of(request.with);
  plan.truth = extras.truth;
  Scenario& scenario = plan.facts.scenario;
  scenario = load_scenario(request.scenario, request.overrides);
  scenario.seeds = {request.seed.value_or(scenario.seeds.front())};
  if (std::exchange(scenario.closed_loop, false))
    plan.notes.emplace_back("there is no estimator in an export: the robot drives by its true pose");
  decide_camera(plan, extras);
  decide_orientation(plan);
  decide_imu_mount(plan);
  plan.facts.rig = calibration_of(scenario);
  if (plan.system != nullptr) plan.facts.names = plan.system->names;
  const std::string name =
      plan.system != nullptr ? plan.system->name : std::string(format_name(plan.formats.front()));
  plan.facts.folder = request.out.empty()
                          ? fs::path("out/datasets") / fmt::format("{}-{}", scenario.name, name)
                          : request.out;
  return plan;
}

ExportedDataset export_dataset(const ExportPlan& plan, const ExportRequest& request,
                               const std::atomic<bool>& stop, Progress& progress) {
  ScenarioWorld place(plan.facts.scenario);
  place.world();  // before anything is written
  const DatasetFolder folder(plan.facts.folder, key_of(plan), request.if_exists);
  if (folder.complete()) return {.outcome = {}, .was_complete = true};
  ExportedDataset dataset;
  dataset.outcome = run_export(place, sinks_of(plan, place.world()), request.threads, stop, progress);
  describe(plan, dataset.outcome.counts);
  folder.mark_complete();
  return dataset;
}

}  // namespace vsslam

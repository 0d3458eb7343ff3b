#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/datasets/export/dataset_export.h"
#include "scenarios/run/interrupt.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

namespace {

struct ExportArguments {
  ExportRequest request;
  std::vector<std::string> settings;
  std::string seed;
  bool resume = false, overwrite = false;
};

ExportRequest request_of(const ExportArguments& arguments, const Console& console) {
  ExportRequest request = arguments.request;
  for (const std::string& setting : arguments.settings) request.overrides.push_back(Override::parse(setting));
  if (!arguments.seed.empty()) {
    const std::vector<uint64_t> seeds = parse_seeds(arguments.seed);
    if (seeds.size() != 1) throw InputError(fmt::format("--seed {}: expected one number", arguments.seed));
    request.seed = seeds.front();
  }
  if (arguments.resume && arguments.overwrite)
    throw InputError("--resume and --overwrite exclude each other");
  using IfExists = ExportRequest::IfExists;
  if (arguments.resume) request.if_exists = IfExists::resume;
  if (arguments.overwrite) request.if_exists = IfExists::overwrite;
  if (console.out_given) request.out = console.out_folder;
  request.threads = console.threads;
  return request;
}

uintmax_t bytes_in(const std::filesystem::path& folder) {
  uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

std::string stage_text(const WallClock& clock) {
  std::string text;
  for (const WallClock::StageTimes& stage : clock.summary())
    text += fmt::format("{}{} {:.1f} s", text.empty() ? "" : ", ", stage.stage, stage.total_s);
  return text;
}

std::string summary_text(const ExportPlan& plan, const ExportOutcome& outcome, uintmax_t bytes) {
  const DatasetCounts& n = outcome.counts;
  return fmt::format(
      "{}: {:.1f} s, {} scans, {} images, {} IMU samples, {} wheel samples, {:.1f} MB\n"
      "made in {:.1f} s, {:.1f} x real time ({}); {:.0f} MiB at most\n",
      plan.facts.folder.string(), n.duration_s, n.scans, n.images, n.imu, n.wheels,
      static_cast<double>(bytes) * 1e-6, outcome.wall_s, outcome.real_time_factor(),
      stage_text(outcome.clock), peak_rss_mib());
}

nlohmann::ordered_json summary_json(const ExportPlan& plan, const ExportedDataset& dataset, uintmax_t bytes) {
  const DatasetCounts& n = dataset.outcome.counts;
  nlohmann::ordered_json json = {{"folder", plan.facts.folder.string()},
                                 {"scenario", plan.facts.scenario.name},
                                 {"seed", plan.facts.scenario.seeds.front()},
                                 {"system", plan.system != nullptr ? plan.system->name : ""},
                                 {"bytes", bytes},
                                 {"was_complete", dataset.was_complete}};
  for (const DatasetFormat format : plan.formats) json["formats"].push_back(format_name(format));
  if (dataset.was_complete) return json;
  json.update({{"duration_s", n.duration_s},
               {"scans", n.scans},
               {"images", n.images},
               {"imu", n.imu},
               {"wheels", n.wheels},
               {"failure", dataset.outcome.failure},
               {"wall_s", dataset.outcome.wall_s},
               {"real_time_factor", dataset.outcome.real_time_factor()}});
  return json;
}

int export_command(const ExportArguments& arguments, const Console& console) {
  catch_interrupts();
  const ExportRequest request = request_of(arguments, console);
  const ExportPlan plan = plan_export(request);
  if (!console.quiet)
    for (const std::string& note : plan.notes) console.err << note << '\n';
  const auto dataset = [&]() -> ExportedDataset {
    WallClock clock;
    Progress progress(console.progress_style(), console.err, clock, plan.facts.scenario.name);
    try {
      return export_dataset(plan, request, interrupt_flag(), progress);
    } catch (const Interrupted&) {
      throw Interrupted(fmt::format("interrupted; the same command with --resume goes on in {}",
                                    plan.facts.folder.string()));
    }
  }();
  const uintmax_t bytes = bytes_in(plan.facts.folder);
  if (console.json) console.out << summary_json(plan, dataset, bytes).dump(2) << '\n';
  if (dataset.was_complete) {
    console.text() << fmt::format("{}: complete already\n", plan.facts.folder.string());
    return kDone;
  }
  console.text() << summary_text(plan, dataset.outcome, bytes);
  if (dataset.outcome.failure.empty()) return kDone;
  console.err << dataset.outcome.failure << '\n';
  return kExpectationFailed;
}

std::string system_names() {
  std::vector<std::string> names;
  for (const TargetSystem& system : target_systems()) names.push_back(system.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void add_export_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub =
      app.add_subcommand("export", "make a dataset of a scenario, for other systems or for replay");
  const auto arguments = std::make_shared<ExportArguments>();
  ExportRequest& request = arguments->request;
  sub->add_option("scenario", request.scenario, "a name from the library (see list), or a path")->required();
  sub->add_option("--for", request.system, "format, topics and configuration of a system: " + system_names());
  sub->add_option(
      "--format", request.formats,
      "bag, mcap, euroc, kitti, pcd, ply, tum; several with commas between (default: the system's, or bag)");
  sub->add_option("--with", request.with,
                  fmt::format("extras with commas between: camera, {}", fmt::join(truth_names(), ", ")));
  sub->add_option("--seed", arguments->seed, "of the sensors' noise (default: the scenario's first)");
  sub->add_option("--set", arguments->settings,
                  "key=value; changes a setting of the scenario; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* out =
      sub->add_option("--out", console.out_folder,
                      "folder of the dataset (default: out/datasets/<scenario>-<system or format>)");
  sub->add_flag("--resume", arguments->resume,
                "go on with an unfinished export; bags and MCAP files begin anew");
  sub->add_flag("--overwrite", arguments->overwrite, "replace the dataset that is there");
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments, out] {
    console.out_given = out->count() > 0;
    command = [&console, arguments] { return export_command(*arguments, console); };
  });
}

}  // namespace vsslam

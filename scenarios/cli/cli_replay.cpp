#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/cli/run_summary.h"
#include "scenarios/experiment/scenario.h"
#include "scenarios/run/interrupt.h"
#include "scenarios/run/replay.h"
#include "scenarios/run/runner.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

namespace {

struct ReplayArguments {
  std::string recording, rig, methods = "vs-slam", truth, name;
  std::vector<std::string> topics, settings;
  bool salvage = false, undistorted = false;
};

std::map<std::string, std::string> parse_topics(const std::vector<std::string>& texts) {
  const std::vector<std::string> sensors = {"lidar", "imu", "camera", "wheels", "truth"};
  std::map<std::string, std::string> topics;
  for (const std::string& text : texts) {
    const size_t equal = text.find('=');
    const std::string sensor = text.substr(0, equal);
    if (equal == std::string::npos || equal + 1 == text.size() ||
        std::find(sensors.begin(), sensors.end(), sensor) == sensors.end())
      throw InputError(
          fmt::format("--topic {}: expected SENSOR=TOPIC with lidar, imu, camera, wheels or truth", text));
    topics[sensor] = text.substr(equal + 1);
  }
  return topics;
}

ReplayRequest request_of(const ReplayArguments& arguments, const Console& console) {
  ReplayRequest request{.recording = arguments.recording,
                        .rig = arguments.rig,
                        .truth = arguments.truth,
                        .topics = parse_topics(arguments.topics),
                        .salvage = arguments.salvage,
                        .undistorted = arguments.undistorted,
                        .name = arguments.name,
                        .out = console.out_folder};
  for (const std::string& setting : arguments.settings) request.overrides.push_back(Override::parse(setting));
  return request;
}

int replay(const ReplayArguments& arguments, const Console& console) {
  catch_interrupts();
  WallClock clock;
  const std::string title = std::filesystem::path(arguments.recording).filename().string();
  auto progress = std::make_unique<Progress>(console.progress_style(), console.err, clock, title);
  auto source = std::make_unique<ReplayedRecording>(
      request_of(arguments, console), [&shown = *progress](const std::string& note) { shown.note(note); });
  Runner runner(std::move(source), resolve_methods(split_list(arguments.methods)),
                {.out = console.out_folder, .threads = console.threads});
  const std::vector<FinishedRun> runs = run_and_summarize(runner, std::move(progress), console);
  const bool good =
      std::all_of(runs.begin(), runs.end(), [](const FinishedRun& r) { return r.as_expected(); });
  return good ? kDone : kExpectationFailed;
}

}  // namespace

void add_replay_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub = app.add_subcommand("replay", "the same stack on a recording: bag, MCAP, packets, folder");
  const auto arguments = std::make_shared<ReplayArguments>();
  const auto repeated = [&](const char* name, std::vector<std::string>& values, const char* text) {
    sub->add_option(name, values, text)->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  sub->add_option("recording", arguments->recording, "a file, or a dataset's folder")->required();
  sub->add_option("--rig", arguments->rig,
                  "the robot's sheet: a name (see list) or a path (default: rig.yaml beside the recording)");
  sub->add_option("--method", arguments->methods, "names with commas between, or all (default: vs-slam)");
  sub->add_option("--truth", arguments->truth, "a trajectory (TUM, KITTI) or a topic to score against");
  repeated("--topic", arguments->topics, "SENSOR=TOPIC for lidar, imu, camera, wheels, truth; SENSOR=none: unused");
  repeated("--set", arguments->settings, "key=value; changes slam. ... or map_voxel_m; the sensors stand in the sheet");
  sub->add_flag("--salvage", arguments->salvage, "of a broken file, read what is before the break");
  sub->add_flag("--undistorted", arguments->undistorted, "the scans have been undistorted already");
  sub->add_option("--name", arguments->name, "of the result (default: the recording's)");
  sub->add_option("--out", console.out_folder, "folder of the results (default: out/runs)");
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments] {
    command = [&console, arguments] { return replay(*arguments, console); };
  });
}

}  // namespace vsslam

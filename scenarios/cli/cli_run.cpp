#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/cli/run_summary.h"
#include "scenarios/run/interrupt.h"
#include "scenarios/run/runner.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

namespace {

struct RunArguments {
  std::string scenario, methods, seeds;
  std::vector<std::string> settings;
};

Scenario resolve(const RunArguments& arguments) {
  std::vector<Override> overrides;
  for (const std::string& setting : arguments.settings) overrides.push_back(Override::parse(setting));
  Scenario scenario = load_scenario(arguments.scenario, overrides);
  if (!arguments.methods.empty()) scenario.methods = split_list(arguments.methods);
  if (!arguments.seeds.empty()) scenario.seeds = parse_seeds(arguments.seeds);
  resolve_methods(scenario.methods);
  return scenario;
}

int run(const RunArguments& arguments, const Console& console) {
  catch_interrupts();
  const Scenario scenario = resolve(arguments);
  Runner runner(scenario, {.out = console.out_folder, .threads = console.threads});
  WallClock clock;
  const std::vector<FinishedRun> runs = run_and_summarize(
      runner, std::make_unique<Progress>(console.progress_style(), console.err, clock, scenario.name),
      console);
  const bool good =
      std::all_of(runs.begin(), runs.end(), [](const FinishedRun& r) { return r.as_expected(); });
  return good ? kDone : kExpectationFailed;
}

}  // namespace

void add_run_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub = app.add_subcommand("run", "simulate, SLAM in the loop, score, report");
  const auto arguments = std::make_shared<RunArguments>();
  sub->add_option("scenario", arguments->scenario, "a name from the library (see list), or a path")
      ->required();
  sub->add_option("--method", arguments->methods, "names with commas between, or all");
  sub->add_option("--seeds", arguments->seeds, "of the sensors' noise: 1-5 or 1,3");
  sub->add_option("--set", arguments->settings,
                  "key=value; changes a setting of the scenario; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->add_option("--out", console.out_folder, "folder of the results (default: out/runs)");
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments] {
    command = [&console, arguments] { return run(*arguments, console); };
  });
}

}  // namespace vsslam

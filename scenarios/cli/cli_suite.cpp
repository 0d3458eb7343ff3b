#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/run/interrupt.h"
#include "scenarios/stages/wall_clock.h"
#include "scenarios/suite/suite_files.h"
#include "scenarios/suite/suite_runner.h"
#include "scenarios/suite/suite_summary.h"

namespace vsslam {

namespace {

struct SuiteArguments {
  std::string suite, scenarios, methods, seeds, out = "out/suites";
  std::vector<std::string> settings;
  bool fresh = false, resume = false;
};

SuitePlan resolve(const SuiteArguments& arguments) {
  Suite suite = load_suite(arguments.suite);
  if (!arguments.scenarios.empty()) suite.scenarios = split_list(arguments.scenarios);
  if (!arguments.methods.empty()) suite.methods = split_list(arguments.methods);
  if (!arguments.seeds.empty()) suite.seeds = parse_seeds(arguments.seeds);
  for (const std::string& text : arguments.settings) {
    const Override setting = Override::parse(text);
    suite.settings[setting.path] = setting.value;
  }
  return plan_suite(suite, arguments.out);
}

// What the user should know when a suite ends before its time.
void tell_how_to_go_on(const SuiteRunner& runner, const SuitePlan& plan, std::ostream& err) {
  err << fmt::format("{} of {} results are finished and kept in {}; the same command goes on from there.\n",
                     runner.kept() + runner.made(), runner.kept() + runner.missing(), plan.folder.string());
}

int run(const SuiteArguments& arguments, const Console& console) {
  catch_interrupts();
  if (arguments.fresh && arguments.resume) throw InputError("--fresh and --resume exclude each other");
  const SuitePlan plan = resolve(arguments);
  SuiteRunner runner(plan, {.threads = console.threads, .fresh = arguments.fresh});
  if (!console.quiet)
    console.err << fmt::format("suite {}: {} runs to make, {} kept\n", plan.suite.name, runner.missing(),
                               runner.kept());
  if (runner.missing() > 0) remove_suite_files(plan);
  try {
    WallClock clock;
    Progress progress(console.progress_style(), console.err, clock, plan.suite.name);
    runner.run(interrupt_flag(), progress);
  } catch (...) {
    tell_how_to_go_on(runner, plan, console.err);
    throw;
  }
  const SuiteFigures figures(plan, runner.failures());
  write_suite_files(figures);
  console.text() << suite_text(figures);
  if (console.json) console.out << suite_json(figures);
  return figures.as_expected() ? kDone : kExpectationFailed;
}

}  // namespace

void add_suite_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub = app.add_subcommand(
      "suite",
      "run scenarios x methods x seeds and write tables and a report\n"
      "Results that are there already, made from the same settings by the same build, are kept: after an "
      "interruption the same command goes on.");
  const auto arguments = std::make_shared<SuiteArguments>();
  sub->add_option("suite", arguments->suite, "a name from the library (see list), or a path")->required();
  sub->add_option("--scenarios", arguments->scenarios, "names with commas between, in place of the suite's");
  sub->add_option("--method", arguments->methods, "names with commas between, or all");
  sub->add_option("--seeds", arguments->seeds, "of the sensors' noise: 1-5 or 1,3");
  sub->add_option("--set", arguments->settings,
                  "key=value; changes a setting of every scenario; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->add_flag("--resume", arguments->resume, "keep what is finished (so it is without this flag, too)");
  sub->add_flag("--fresh", arguments->fresh, "make everything anew");
  sub->add_option("--out", arguments->out, "folder of the suites (default: out/suites)");
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments] {
    command = [&console, arguments] { return run(*arguments, console); };
  });
}

}  // namespace vsslam

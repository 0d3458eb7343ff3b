#include "scenarios/cli/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <exception>
#include <filesystem>
#include <new>

#include "core/errors.h"
#include "core/ordered_parallel.h"
#include "core/suggestion.h"
#include "scenarios/stages/wall_clock.h"

namespace vsslam {

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options({}))
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// Mistyped commands and options, which CLI11 reports without a hint.
void check_words(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front().starts_with('-')) return;
  const std::string& name = arguments.front();
  const std::vector<std::string> commands = command_names(app);
  if (std::find(commands.begin(), commands.end(), name) == commands.end())
    throw InputError(fmt::format("unknown command \"{}\" ({})", name, suggestion(name, commands)));
  const std::vector<std::string> known = option_names(*app.get_subcommand(name));
  for (size_t i = 1; i < arguments.size(); ++i) {
    if (!arguments[i].starts_with("--") || arguments[i] == "--") continue;
    const std::string option = arguments[i].substr(0, arguments[i].find('='));
    if (std::find(known.begin(), known.end(), option) == known.end())
      throw InputError(fmt::format("{}: unknown option {} ({})", name, option, suggestion(option, known)));
  }
}

int parse_and_run(CLI::App& app, const std::vector<std::string>& arguments, Console& console,
                  Command& command) {
  check_words(app, arguments);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e, console.out, console.err);  // --help, --version
    throw InputError(e.what());
  }
  if (console.threads == 0) console.threads = available_cores();
  set_thread_count(console.threads);
  return command();
}

// Turns what may go wrong into an exit code and one line.
int guarded(const std::function<int()>& body, std::ostream& err) {
  try {
    return body();
  } catch (const InputError& e) {
    err << "vsslam: " << e.what() << '\n';
    return kBadInput;
  } catch (const Interrupted& e) {
    err << "vsslam: " << e.what() << '\n';
  } catch (const std::bad_alloc&) {
    err << "vsslam: out of memory\n";
  } catch (const std::exception& e) {  // ResourceError, and what the system says
    err << "vsslam: " << e.what() << '\n';
  }
  return kStopped;
}

uint64_t parse_seed(const std::string& text, const std::string& whole) {
  uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size())
    throw InputError(fmt::format("--seeds {}: expected whole numbers such as 1-5 or 1,3", whole));
  return seed;
}

}  // namespace

Progress::Style Console::progress_style() const {
  if (quiet) return Progress::Style::none;
  return err_is_terminal ? Progress::Style::bar : Progress::Style::lines;
}

void add_common_options(CLI::App& command, Console& console) {
  command
      .add_option("--threads", console.threads,
                  "threads to use (default: all cores; results do not depend on it)")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--json", console.json, "print JSON on standard output, all else on standard error");
  command.add_flag("--quiet", console.quiet, "no progress");
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> items;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    items.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return items;
}

std::vector<uint64_t> parse_seeds(const std::string& text) {
  constexpr uint64_t kMost = 10000;
  std::vector<uint64_t> seeds;
  for (const std::string& item : split_list(text)) {
    const size_t dash = item.find('-');
    const uint64_t first = parse_seed(item.substr(0, dash), text);
    const uint64_t last = dash == std::string::npos ? first : parse_seed(item.substr(dash + 1), text);
    if (last < first || last - first >= kMost)
      throw InputError(fmt::format("--seeds {}: expected a range such as 1-5, got {}", text, item));
    for (uint64_t seed = first; seed <= last; ++seed)
      if (std::find(seeds.begin(), seeds.end(), seed) == seeds.end()) seeds.push_back(seed);
  }
  return seeds;
}

int run_cli(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
            bool err_is_terminal) {
  return guarded(
      [&] {
        Console console{.out = out, .err = err, .err_is_terminal = err_is_terminal};
        Command command;
        CLI::App app(
            "VS-SLAM Testbed: simulate a Scout in a corridor, run SLAM in the loop, score it against exact "
            "truth.\nExit codes: 0 done as expected, 1 an expectation failed or a result is worthless, 2 bad "
            "input, 3 stopped.",
            "vsslam");
        app.require_subcommand(1);
        app.set_help_all_flag("--help-all", "help of every command");
        add_run_command(app, console, command);
        add_replay_command(app, console, command);
        add_suite_command(app, console, command);
        add_export_command(app, console, command);
        add_world_command(app, console, command);
        add_evaluate_command(app, console, command);
        add_optimize_command(app, console, command);
        add_report_command(app, console, command);
        add_list_command(app, console, command);
        return parse_and_run(app, arguments, console, command);
      },
      err);
}

}  // namespace vsslam

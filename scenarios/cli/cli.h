// The command line. One function per command, each in its own file.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenarios/run/progress.h"

namespace CLI {
class App;
}

namespace vsslam {

/// Exit codes. A result that is worthless (Health) counts as a failed expectation.
inline constexpr int kDone = 0, kExpectationFailed = 1, kBadInput = 2, kStopped = 3;

/// Options that every command has, and where it prints.
struct Console {
  std::ostream& out;  ///< the answer
  std::ostream& err;  ///< everything else
  bool err_is_terminal = false;
  std::filesystem::path out_folder = "out/runs";
  bool out_given = false;
  int threads = 0;
  bool json = false, quiet = false;

  /// Text for a person: the answer, unless the answer is JSON.
  std::ostream& text() const { return json ? err : out; }
  Progress::Style progress_style() const;
};

/// A command once it is parsed; returns the exit code.
using Command = std::function<int()>;

void add_run_command(CLI::App& app, Console& console, Command& command);
void add_replay_command(CLI::App& app, Console& console, Command& command);
void add_suite_command(CLI::App& app, Console& console, Command& command);
void add_world_command(CLI::App& app, Console& console, Command& command);
void add_evaluate_command(CLI::App& app, Console& console, Command& command);
void add_optimize_command(CLI::App& app, Console& console, Command& command);
void add_report_command(CLI::App& app, Console& console, Command& command);
void add_export_command(CLI::App& app, Console& console, Command& command);
void add_list_command(CLI::App& app, Console& console, Command& command);

/// --out, --threads, --json, --quiet.
void add_common_options(CLI::App& command, Console& console);

/// Runs one command line (without the program's name). Never throws.
int run_cli(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
            bool err_is_terminal = false);

/// "1-5", "3", "1,3,7-9". Throws InputError.
std::vector<uint64_t> parse_seeds(const std::string& text);
/// "a,b,c"
std::vector<std::string> split_list(const std::string& text);

}  // namespace vsslam

#include <CLI/CLI.hpp>
#include <memory>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/report/report.h"
#include "scenarios/suite/suite_files.h"

namespace vsslam {

namespace {

struct ReportArguments {
  std::vector<std::string> folders;
  std::string out = "out/comparison.html";
};

// Of the results as they are, whichever build made them.
void rebuild_suite(const std::filesystem::path& folder) {
  SuitePlan plan = plan_suite(load_suite((folder / "suite.yaml").string()), folder.parent_path());
  plan.folder = folder;
  write_suite_files(SuiteFigures(plan, {}, true));
}

int report(const ReportArguments& arguments, const Console& console) {
  std::vector<std::filesystem::path> folders;
  bool suites = false;
  for (const std::string& folder : arguments.folders) {
    if (!std::filesystem::is_directory(folder)) throw InputError(folder + ": no such folder");
    folders.emplace_back(folder);
  }
  for (const std::filesystem::path& folder : folders) {
    const bool suite = std::filesystem::exists(folder / "suite.yaml");
    suites |= suite;
    suite ? rebuild_suite(folder) : write_report(folder);
    console.text() << "report: " << (folder / "report.html").string() << '\n';
  }
  if (folders.size() > 1 && !suites) {
    write_comparison(folders, arguments.out);
    console.text() << "comparison: " << arguments.out << '\n';
  }
  return kDone;
}

}  // namespace

void add_report_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub = app.add_subcommand(
      "report", "rebuild the report of a result folder or a suite's; several results: side by side as well");
  const auto arguments = std::make_shared<ReportArguments>();
  sub->add_option("folders", arguments->folders, "result folders")->required();
  sub->add_option("--out", arguments->out, "the page that compares (default: out/comparison.html)");
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments] {
    command = [&console, arguments] { return report(*arguments, console); };
  });
}

}  // namespace vsslam

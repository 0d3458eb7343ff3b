#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/datasets/systems/target_system.h"
#include "scenarios/experiment/library_files.h"
#include "scenarios/experiment/scenario.h"
#include "scenarios/suite/suite.h"

namespace vsslam {

namespace {

std::string description_of(const std::string& scenario) {
  try {
    return load_scenario(scenario).description;
  } catch (const InputError& e) {
    return e.what();
  }
}

std::string description_of_suite(const std::string& suite) {
  try {
    return load_suite(suite).description;
  } catch (const InputError& e) {
    return e.what();
  }
}

int list(const Console& console) {
  nlohmann::ordered_json json = {{"scenarios", nlohmann::ordered_json::array()}};
  std::string text = "scenarios\n";
  for (const std::string& name : library_names("scenarios")) {
    const std::string description = description_of(name);
    text += fmt::format("  {:<18} {}\n", name, description);
    json["scenarios"].push_back({{"name", name}, {"description", description}});
  }
  text += "suites\n";
  json["suites"] = nlohmann::ordered_json::array();
  for (const std::string& name : library_names("suites")) {
    const std::string description = description_of_suite(name);
    text += fmt::format("  {:<18} {}\n", name, description);
    json["suites"].push_back({{"name", name}, {"description", description}});
  }
  for (const char* kind : {"worlds", "rigs", "sheets"}) {
    json[kind] = library_names(kind);
    text += fmt::format("{}\n", kind);
    for (const std::string& name : library_names(kind)) text += fmt::format("  {}\n", name);
  }
  text += "methods\n";
  for (const Method method : all_methods()) {
    json["methods"].push_back(method_name(method));
    text += fmt::format("  {}\n", method_name(method));
  }
  text += "systems that export makes datasets for\n";
  for (const TargetSystem& system : target_systems()) {
    json["systems"].push_back(system.name);
    text += fmt::format("  {}\n", system.name);
  }
  console.out << (console.json ? json.dump(2) + "\n" : text);
  return kDone;
}

}  // namespace

void add_list_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub = app.add_subcommand(
      "list", "scenarios, suites, worlds, rigs, sheets, methods and systems to export for");
  add_common_options(*sub, console);
  sub->callback([&console, &command] { command = [&console] { return list(console); }; });
}

}  // namespace vsslam

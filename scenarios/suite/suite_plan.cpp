#include "scenarios/suite/suite_plan.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/experiment/fingerprint.h"
#include "scenarios/run/simulated_drive.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) ? read_file(file) : std::string();
}

std::string made_by(const fs::path& folder) {
  const auto timing = nlohmann::json::parse(text_of(folder / "timing.json"), nullptr, false);
  return timing.is_object() ? timing.value("made_by", "") : "";
}

}  // namespace

std::vector<PlannedRun> SuitePlan::runs() const {
  std::vector<PlannedRun> all;
  for (size_t i = 0; i < scenarios.size(); ++i)
    for (const Method method : methods)
      for (const uint64_t seed : suite.seeds)
        all.push_back({i, method, seed, result_path(folder, scenarios[i].name, method, seed)});
  return all;
}

std::string SuitePlan::resolved(const PlannedRun& run) const {
  return save_config(scenario_of_run(scenarios[run.scenario], run.method, run.seed));
}

SuitePlan plan_suite(const Suite& suite, const fs::path& out, const std::vector<Override>& overrides) {
  SuitePlan plan{
      .suite = suite, .folder = out / suite.name, .scenarios = {}, .methods = resolve_methods(suite.methods)};
  std::vector<Override> settings;
  for (const auto& [path, value] : suite.settings) settings.push_back({path, value});
  settings.insert(settings.end(), overrides.begin(), overrides.end());
  std::set<std::string> names;
  for (const std::string& name : suite.scenarios) {
    try {
      plan.scenarios.push_back(load_scenario(name, settings));
    } catch (const InputError& e) {
      throw InputError(fmt::format("suite {}: scenario {}: {}", suite.name, name, e.what()));
    }
    if (!names.insert(plan.scenarios.back().name).second)
      throw InputError(
          fmt::format("suite {}: two scenarios are named {}", suite.name, plan.scenarios.back().name));
  }
  return plan;
}

StoredRun stored_run(const SuitePlan& plan, const PlannedRun& run) {
  const std::string scenario = text_of(run.folder / "scenario.yaml");
  if (scenario.empty() || text_of(run.folder / "metrics.json").empty()) return StoredRun::none;
  if (scenario != plan.resolved(run)) return StoredRun::other_scenario;
  return made_by(run.folder) == fingerprint(plan.scenarios[run.scenario]) ? StoredRun::same
                                                                          : StoredRun::other_build;
}

}  // namespace vsslam

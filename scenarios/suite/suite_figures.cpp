#include "scenarios/suite/suite_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/health/health.h"

namespace vsslam {

namespace {

using nlohmann::json;

json read_json(const std::filesystem::path& path) {
  try {
    return json::parse(read_file(path));
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

// "loops.recall" -> /loops/recall
json::json_pointer pointer_to(std::string metric) {
  std::replace(metric.begin(), metric.end(), '.', '/');
  return json::json_pointer("/" + metric);
}

std::vector<std::string> failed_expectations(const json& metrics) {
  std::vector<std::string> failed;
  const json expectations = metrics.value("expectations", json::object());
  for (const auto& [name, e] : expectations.items())
    if (!e.value("pass", false))
      failed.push_back(
          fmt::format("{} = {} ({})", name, e.value("value", json()).dump(), e.value("bound", "")));
  return failed;
}

std::optional<double> figure_of(const json& value) {
  if (value.is_array()) return static_cast<double>(value.size());
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

void read_result(RunFigures& figures) {
  const json metrics = read_json(figures.run.folder / "metrics.json");
  figures.present = true;
  if (metrics.contains("failure") && metrics["failure"].is_string()) figures.failure = metrics["failure"];
  for (const std::string& name : metric_names()) {
    const json::json_pointer at = pointer_to(name);
    figures.values.push_back(metrics.contains(at) ? figure_of(metrics.at(at)) : std::nullopt);
  }
  const json health = metrics.value("health", json::object());
  if (health.contains("worthless") && health["worthless"].is_string())
    figures.worthless = health["worthless"];
  figures.failed_expectations = failed_expectations(metrics);
  if (std::filesystem::exists(figures.run.folder / "timing.json"))
    figures.made_by = read_json(figures.run.folder / "timing.json").value("made_by", "");
}

const char* why_missing(StoredRun stored) {
  switch (stored) {
    case StoredRun::none:
      return "not made yet";
    case StoredRun::other_scenario:
      return "made from other settings";
    default:
      return "made by another build";
  }
}

}  // namespace

std::optional<Spread> spread_of(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  Spread spread{.count = values.size(), .low = values[0], .high = values[0]};
  for (const double value : values) {
    spread.mean += value;
    spread.low = std::min(spread.low, value);
    spread.high = std::max(spread.high, value);
  }
  spread.mean /= static_cast<double>(values.size());
  double squares = 0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  if (values.size() > 1) spread.deviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
  return spread;
}

std::optional<double> RunFigures::value(const std::string& metric) const {
  const auto& names = metric_names();
  const auto at = std::find(names.begin(), names.end(), metric) - names.begin();
  return at < static_cast<std::ptrdiff_t>(values.size()) ? values[static_cast<size_t>(at)] : std::nullopt;
}

bool RunFigures::blind() const {
  return !worthless.empty() ||
         value("health.scans_prior_only").value_or(0) > kBlindShare * value("scans").value_or(0);
}

SuiteFigures::SuiteFigures(const SuitePlan& plan, std::span<const SuiteFailure> failures, bool any_build)
    : plan_(plan) {
  for (const PlannedRun& run : plan.runs()) {
    RunFigures figures{.run = run};
    const StoredRun stored = stored_run(plan, run);
    const auto failure = std::find_if(failures.begin(), failures.end(), [&](const SuiteFailure& f) {
      return f.scenario == run.scenario && f.method == run.method && f.seed == run.seed;
    });
    if (failure != failures.end()) {
      figures.failure = failure->why;
    } else if (stored == StoredRun::same || (any_build && stored == StoredRun::other_build)) {
      read_result(figures);
    } else {
      figures.failure = why_missing(stored);
    }
    runs_.push_back(std::move(figures));
  }
}

std::optional<Spread> SuiteFigures::over_seeds(size_t scenario, Method method,
                                               const std::string& metric) const {
  std::vector<double> values;
  for (const RunFigures& r : runs_)
    if (r.run.scenario == scenario && r.run.method == method)
      if (const auto value = r.value(metric)) values.push_back(*value);
  return spread_of(values);
}

std::optional<Spread> SuiteFigures::over_runs(Method method, const std::string& metric) const {
  std::vector<double> values;
  for (const RunFigures& r : runs_)
    if (r.run.method == method)
      if (const auto value = r.value(metric)) values.push_back(*value);
  return spread_of(values);
}

std::vector<SuiteFigures::Expected> SuiteFigures::expected() const {
  std::vector<Expected> all;
  for (const Method method : plan_.methods)
    for (const auto& [metric, bound] : bounds_for(plan_.suite.expect, std::string(method_name(method)))) {
      const auto spread = over_runs(method, metric);
      const auto mean = spread ? std::optional(spread->mean) : std::nullopt;
      all.push_back({method, {metric, mean, bound, mean && bound.holds(*mean)}});
    }
  return all;
}

size_t SuiteFigures::present() const {
  return static_cast<size_t>(
      std::count_if(runs_.begin(), runs_.end(), [](const RunFigures& r) { return r.present; }));
}

bool SuiteFigures::blind(size_t scenario, Method method) const {
  return std::any_of(runs_.begin(), runs_.end(), [&](const RunFigures& r) {
    return r.run.scenario == scenario && r.run.method == method && r.blind();
  });
}

size_t SuiteFigures::builds() const {
  std::set<std::string> builds;
  for (const RunFigures& r : runs_)
    if (r.present) builds.insert(r.made_by);
  return builds.size();
}

bool SuiteFigures::as_expected() const {
  const std::vector<Expected> suite = expected();
  return std::all_of(runs_.begin(), runs_.end(),
                     [](const RunFigures& r) {
                       return r.present && r.failure.empty() && r.worthless.empty() &&
                              r.failed_expectations.empty();
                     }) &&
         std::all_of(suite.begin(), suite.end(), [](const Expected& e) { return e.result.pass; });
}

}  // namespace vsslam

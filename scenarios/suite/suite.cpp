#include "scenarios/suite/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.h"
#include "scenarios/experiment/library_files.h"
#include "slam/loop/loop_config.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> method_words() {
  std::vector<std::string> words;
  for (const Method method : all_methods()) words.emplace_back(method_name(method));
  return words;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// `key` holds a word that is none of `words`: an error there, with the nearest one.
void check_word(Fields& f, const char* key, const char* what, const std::string& word,
                const std::vector<std::string>& words) {
  if (contains(words, word)) return;
  const std::string near = nearest(word, words);
  f.check(false, key,
          fmt::format("{}, got \"{}\"{}", what, word,
                      near.empty() ? "" : fmt::format(" (did you mean {}?)", near)));
}

bool is_path(const std::string& scenario) {
  return scenario.ends_with(".yaml") || scenario.find('/') != std::string::npos;
}

void find_scenarios(Fields& f, std::vector<std::string>& scenarios) {
  for (std::string& scenario : scenarios) {
    if (!is_path(scenario)) {
      check_word(f, "scenarios", "names of scenarios", scenario, library_names("scenarios"));
      continue;
    }
    scenario = fs::absolute(f.folder() / scenario).lexically_normal().string();
    f.check(fs::exists(scenario), "scenarios", fmt::format("files that exist, got {}", scenario));
  }
}

}  // namespace

void ReferenceFigures::fields(Fields& f) {
  f("source", source);
  f("figures", figures);
  if (!f.loading()) return;
  for (const auto& [scenario, methods] : figures)
    for (const auto& [method, metrics] : methods) {
      check_word(f, "figures", "names of methods below a scenario", method, method_words());
      for (const auto& [metric, value] : metrics)
        check_word(f, "figures", "names of metrics below a method", metric, metric_names());
    }
}

std::optional<double> ReferenceFigures::find(const std::string& scenario, const std::string& method,
                                             const std::string& metric) const {
  const auto of_scenario = figures.find(scenario);
  if (of_scenario == figures.end()) return std::nullopt;
  const auto of_method = of_scenario->second.find(method);
  if (of_method == of_scenario->second.end()) return std::nullopt;
  const auto value = of_method->second.find(metric);
  return value == of_method->second.end() ? std::nullopt : std::optional(value->second);
}

void Suite::fields(Fields& f) {
  f("name", name);
  f("description", description);
  f("scenarios", scenarios);
  f("methods", methods);
  f("seeds", seeds);
  f("settings", settings);
  f("focus", focus);
  f("error_metric", error_metric);
  f("reference", reference);
  expectation_fields(f, expect);
  if (!f.loading()) return;
  f.check(!scenarios.empty(), "scenarios", "at least one scenario");
  f.check(!seeds.empty(), "seeds", "at least one seed");
  f.check(!methods.empty(), "methods", "at least one method");
  find_scenarios(f, scenarios);
  std::vector<std::string> words = method_words();
  check_word(f, "focus", "the name of a method", focus, words);
  words.emplace_back("all");
  for (const std::string& method : methods)
    check_word(f, "methods", "names of methods, or all", method, words);
  for (const auto& [scenario, metric] : error_metric)
    check_word(f, "error_metric", "names of metrics", metric, metric_names());
  f.check(name.find('/') == std::string::npos && !name.starts_with('.'), "name",
          "a name that can be a folder's");
}

const std::string& Suite::error_metric_of(const std::string& scenario) const {
  static const std::string usual = "ate_rmse_m";
  const auto own = error_metric.find(scenario);
  return own == error_metric.end() ? usual : own->second;
}

Suite load_suite(const std::string& name_or_path) {
  const fs::path path = find_file("suites", name_or_path);
  Suite suite;
  load_config(path, suite, library());
  if (suite.name.empty()) suite.name = path.stem().string();
  return suite;
}

}  // namespace vsslam

#include "scenarios/suite/suite_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/suite/suite_tables.h"

namespace vsslam {

namespace {

using Json = nlohmann::ordered_json;

std::string aligned(const SuiteTable& table) {
  std::vector<std::vector<std::string>> rows = {{table.title}};
  rows[0].insert(rows[0].end(), table.columns.begin(), table.columns.end());
  for (const SuiteTable::Row& row : table.rows) {
    rows.push_back({row.scenario});
    for (const TableCell& cell : row.cells)
      rows.back().push_back(cell.value.empty() ? "-" : cell.best ? "*" + cell.value : cell.value);
  }
  std::vector<size_t> widths(rows[0].size(), 0);
  for (const auto& row : rows)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    text += fmt::format("{:<{}}", row[0], widths[0]);
    for (size_t i = 1; i < row.size(); ++i) text += fmt::format("  {:>{}}", row[i], widths[i]);
    text += '\n';
  }
  return text;
}

Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json errors(const SuiteFigures& figures) {
  Json list = Json::array();
  const SuitePlan& plan = figures.plan();
  for (size_t i = 0; i < plan.scenarios.size(); ++i)
    for (const Method method : plan.methods) {
      const std::string& scenario = plan.scenarios[i].name;
      const std::string& metric = plan.suite.error_metric_of(scenario);
      const std::string name(method_name(method));
      const auto spread = figures.over_seeds(i, method, metric);
      list.push_back({{"scenario", scenario},
                      {"method", name},
                      {"metric", metric},
                      {"mean", spread ? Json(spread->mean) : Json(nullptr)},
                      {"deviation", spread ? Json(spread->deviation) : Json(nullptr)},
                      {"seeds", spread ? spread->count : 0},
                      {"reference", number(plan.suite.reference.find(scenario, name, metric))}});
    }
  return list;
}

}  // namespace

std::string suite_text(const SuiteFigures& figures) {
  const SuitePlan& plan = figures.plan();
  std::string text = aligned(suite_tables(figures).front());
  for (const std::string& sentence : losses(figures)) text += sentence + '\n';
  for (const SuiteFigures::Expected& e : figures.expected())
    text += fmt::format("{}  mean {} = {} ({})  {}\n", e.result.pass ? "PASS" : "FAIL", e.result.metric,
                        e.result.value ? fmt::format("{:.6g}", *e.result.value) : "none",
                        e.result.bound.text(), method_name(e.method));
  for (const RunFigures& r : figures.runs()) {
    const std::string name = fmt::format("{} {} seed {}", plan.scenarios[r.run.scenario].name,
                                         method_name(r.run.method), r.run.seed);
    if (!r.failure.empty()) text += fmt::format("FAIL  {}  {}\n", r.failure, name);
    if (!r.worthless.empty()) text += fmt::format("FAIL  worthless: {}  {}\n", r.worthless, name);
    if (const double warnings = r.value("health.warnings").value_or(0); warnings > 0)
      text += fmt::format("WARN  {} warning{} in its metrics.json  {}\n", warnings, warnings > 1 ? "s" : "",
                          name);
    for (const std::string& failed : r.failed_expectations)
      text += fmt::format("FAIL  {}  {}\n", failed, name);
  }
  return text + fmt::format("tables: {}\nreport: {}\n", (plan.folder / "tables.md").string(),
                            (plan.folder / "report.html").string());
}

std::string suite_json(const SuiteFigures& figures) {
  const SuitePlan& plan = figures.plan();
  Json failures = Json::array(), expectations = Json::array();
  for (const RunFigures& r : figures.runs())
    if (!r.failure.empty())
      failures.push_back({{"scenario", plan.scenarios[r.run.scenario].name},
                          {"method", method_name(r.run.method)},
                          {"seed", r.run.seed},
                          {"why", r.failure}});
  for (const RunFigures& r : figures.runs())
    if (!r.worthless.empty())
      failures.push_back({{"scenario", plan.scenarios[r.run.scenario].name},
                          {"method", method_name(r.run.method)},
                          {"seed", r.run.seed},
                          {"why", "worthless: " + r.worthless}});
  for (const SuiteFigures::Expected& e : figures.expected())
    expectations.push_back({{"method", method_name(e.method)},
                            {"metric", e.result.metric},
                            {"value", number(e.result.value)},
                            {"bound", e.result.bound.text()},
                            {"pass", e.result.pass}});
  const Json json = {{"suite", plan.suite.name},
                     {"folder", plan.folder.string()},
                     {"runs", figures.runs().size()},
                     {"present", figures.present()},
                     {"as_expected", figures.as_expected()},
                     {"failures", failures},
                     {"expectations", expectations},
                     {"error", errors(figures)}};
  return json.dump(2) + "\n";
}

}  // namespace vsslam

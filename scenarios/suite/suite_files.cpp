#include "scenarios/suite/suite_files.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "core/files.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/suite/suite_offsets.h"
#include "scenarios/suite/suite_page.h"
#include "scenarios/suite/suite_tables.h"

namespace vsslam {

namespace {

using nlohmann::json;

std::vector<const char*> pointers(const std::vector<std::string>& names) {
  std::vector<const char*> result;
  for (const std::string& name : names) result.push_back(name.c_str());
  return result;
}

void put(CsvWriter& csv, const std::optional<double>& value) {
  if (value) {
    csv(*value);
  } else {
    csv.empty();
  }
}

void put_run(CsvWriter& csv, const SuiteFigures& figures, const PlannedRun& run) {
  csv(figures.plan().scenarios[run.scenario].name)(method_name(run.method))(run.seed);
}

// Markdown's own separators must not come from a name.
std::string escaped(std::string text) {
  for (size_t at = text.find('|'); at != text.npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

std::string cell_markdown(const TableCell& cell) {
  std::string text = cell.value.empty() ? "–" : cell.best ? "**" + cell.value + "**" : cell.value;
  if (!cell.deviation.empty()) text += " ± " + cell.deviation;
  if (!cell.reference.empty()) text += " [" + cell.reference + "]";
  return text;
}

std::string table_markdown(const SuiteTable& table) {
  std::string text = fmt::format("## {}\n\n{}\n\n| sequence |", table.title, table.note), rule = "|---|";
  for (const std::string& column : table.columns) text += fmt::format(" {} |", column), rule += "---:|";
  text += "\n" + rule + "\n";
  for (const SuiteTable::Row& row : table.rows) {
    text += fmt::format("| {} |", escaped(row.scenario));
    for (const TableCell& cell : row.cells) text += fmt::format(" {} |", cell_markdown(cell));
    text += '\n';
  }
  return text + '\n';
}

std::string expectations_markdown(const SuiteFigures& figures) {
  std::string text;
  for (const SuiteFigures::Expected& e : figures.expected())
    text +=
        fmt::format("* {}: mean {} of {} = {} ({})\n", e.result.pass ? "pass" : "**fail**", e.result.metric,
                    method_name(e.method), e.result.value ? fmt::format("{:.6g}", *e.result.value) : "none",
                    e.result.bound.text());
  for (const RunFigures& r : figures.runs())
    for (const std::string& failed : r.failed_expectations)
      text += fmt::format("* **fail**: {} {} seed {}: {}\n", figures.plan().scenarios[r.run.scenario].name,
                          method_name(r.run.method), r.run.seed, failed);
  return text.empty() ? text : "## Expectations\n\n" + text + "\n";
}

std::string failures_markdown(const SuiteFigures& figures) {
  std::string text;
  for (const RunFigures& r : figures.runs())
    if (!r.failure.empty())
      text += fmt::format("* {} {} seed {}: {}\n", figures.plan().scenarios[r.run.scenario].name,
                          method_name(r.run.method), r.run.seed, r.failure);
  for (const RunFigures& r : figures.runs())
    if (!r.worthless.empty())
      text += fmt::format("* {} {} seed {}: worthless: {}\n", figures.plan().scenarios[r.run.scenario].name,
                          method_name(r.run.method), r.run.seed, r.worthless);
  return text.empty() ? text : "## Runs that failed, are missing or worthless\n\n" + text + "\n";
}

std::string losses_markdown(const SuiteFigures& figures) {
  if (!has_focus(figures)) return {};
  std::string text = fmt::format("## Where {} is behind\n\n", figures.plan().suite.focus);
  const std::vector<std::string> sentences = losses(figures);
  if (sentences.empty()) text += "Nowhere, to the digits shown.\n";
  for (const std::string& sentence : sentences) text += "* " + sentence + "\n";
  return text + "\n";
}

std::optional<json> timing_of(const RunFigures& run) {
  const auto path = run.run.folder / "timing.json";
  if (!run.present || !std::filesystem::exists(path)) return std::nullopt;
  return json::parse(read_file(path), nullptr, false);
}

std::optional<double> number(const json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

}  // namespace

std::string summary_csv(const SuiteFigures& figures) {
  std::vector<std::string> names = {"scenario", "method", "seed", "failure", "failed_expectations"};
  names.insert(names.end(), metric_names().begin(), metric_names().end());
  const std::vector<const char*> columns = pointers(names);
  CsvWriter csv(columns);
  for (const RunFigures& r : figures.runs()) {
    put_run(csv, figures, r.run);
    csv(r.failure)(r.failed_expectations.size());
    for (const std::string& metric : metric_names()) put(csv, r.value(metric));
    csv.end_row();
  }
  return csv.text();
}

std::string tables_csv(const SuiteFigures& figures) {
  constexpr std::array kColumns = {"scenario",  "method", "metric", "seeds",    "mean",
                                   "deviation", "low",    "high",   "reference"};
  CsvWriter csv(kColumns);
  const SuitePlan& plan = figures.plan();
  for (size_t i = 0; i < plan.scenarios.size(); ++i)
    for (const Method method : plan.methods)
      for (const std::string& metric : metric_names()) {
        const auto spread = figures.over_seeds(i, method, metric);
        const auto reference =
            plan.suite.reference.find(plan.scenarios[i].name, std::string(method_name(method)), metric);
        if (!spread && !reference) continue;
        csv(plan.scenarios[i].name)(method_name(method))(metric)(spread ? spread->count : 0);
        if (spread) {
          csv(spread->mean)(spread->deviation)(spread->low)(spread->high);
        } else {
          csv.empty(4);
        }
        put(csv, reference);
        csv.end_row();
      }
  return csv.text();
}

std::string tables_markdown(const SuiteFigures& figures) {
  const Suite& suite = figures.plan().suite;
  std::string text = fmt::format("# Suite {}\n\n", suite.name);
  if (!suite.description.empty()) text += suite.description + "\n\n";
  text += fmt::format("{} of {} runs. ", figures.present(), figures.runs().size());
  text += suite.seeds.size() == 1
              ? "One seed."
              : fmt::format("Means over {} seeds ± sample standard deviation.", suite.seeds.size());
  text += " The best of a row is bold.";
  if (!suite.reference.figures.empty()) text += fmt::format(" In brackets: {}.", suite.reference.source);
  text += "\n\n";
  for (const SuiteTable& table : suite_tables(figures)) text += table_markdown(table);
  return text + losses_markdown(figures) + expectations_markdown(figures) + failures_markdown(figures);
}

std::string timing_csv(const SuiteFigures& figures) {
  std::vector<std::optional<json>> timings;
  std::set<std::string> stages;
  for (const RunFigures& r : figures.runs()) {
    timings.push_back(timing_of(r));
    if (timings.back() && timings.back()->contains("stages"))
      for (const auto& [stage, unused] : timings.back()->at("stages").items()) stages.insert(stage);
  }
  std::vector<std::string> names = {"scenario", "method",       "seed", "real_time_factor",
                                    "wall_s",   "peak_rss_mib", "cores"};
  for (const std::string& stage : stages)
    names.push_back(stage + "_median_ms"), names.push_back(stage + "_p99_ms");
  const std::vector<const char*> columns = pointers(names);
  CsvWriter csv(columns);
  for (size_t i = 0; i < timings.size(); ++i) {
    if (!timings[i]) continue;
    put_run(csv, figures, figures.runs()[i].run);
    for (const char* key : {"real_time_factor", "wall_s", "peak_rss_mib", "cores"})
      put(csv, number(*timings[i], key));
    const json all = timings[i]->value("stages", json::object());
    for (const std::string& stage : stages) {
      const json one = all.value(stage, json::object());
      put(csv, number(one, "median_ms")), put(csv, number(one, "p99_ms"));
    }
    csv.end_row();
  }
  return csv.text();
}

void write_suite_files(const SuiteFigures& figures) {
  const std::filesystem::path& folder = figures.plan().folder;
  std::filesystem::create_directories(folder);
  write_file(folder / "suite.yaml", save_config(figures.plan().suite));
  write_file(folder / "summary.csv", summary_csv(figures));
  write_file(folder / "tables.csv", tables_csv(figures));
  write_file(folder / "tables.md", tables_markdown(figures));
  write_file(folder / "timing.csv", timing_csv(figures));
  const std::vector<MethodOffsets> offsets = recall_over_offset(figures);
  write_file(folder / "offsets.csv", offsets_csv(offsets));
  write_file(folder / "report.html", suite_page(figures, offsets));
}

void remove_suite_files(const SuitePlan& plan) {
  for (const char* name :
       {"suite.yaml", "summary.csv", "tables.csv", "tables.md", "offsets.csv", "timing.csv", "report.html"}) {
    std::error_code ignored;
    std::filesystem::remove(plan.folder / name, ignored);
  }
}

}  // namespace vsslam

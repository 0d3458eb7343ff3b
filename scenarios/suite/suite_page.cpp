#include "scenarios/suite/suite_page.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "core/files.h"
#include "report_page.h"
#include "scenarios/report/page_tables.h"
#include "scenarios/report/page_template.h"
#include "scenarios/suite/suite_drawings.h"
#include "scenarios/suite/suite_tables.h"

namespace vsslam {

namespace {

using nlohmann::json;

std::string cell_html(const TableCell& cell) {
  std::string text = cell.value.empty() ? "<span class=\"none\">–</span>" : escape_html(cell.value);
  if (!cell.deviation.empty()) text += fmt::format("<small> ± {}</small>", cell.deviation);
  if (!cell.reference.empty()) text += fmt::format("<small class=\"reference\">{}</small>", cell.reference);
  return fmt::format("<td{}>{}</td>", cell.best ? " class=\"best\"" : "", text);
}

std::string table_html(const SuiteTable& table) {
  std::string html = "<div class=\"scroll\"><table class=\"figures suite\">\n<thead><tr><td></td>";
  for (const std::string& column : table.columns)
    html += fmt::format("<th scope=\"col\" data-method=\"{0}\">{0}</th>", escape_html(column));
  html += "</tr></thead>\n<tbody>\n";
  for (const SuiteTable::Row& row : table.rows) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", escape_html(row.scenario));
    for (const TableCell& cell : row.cells) html += cell_html(cell);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string table_section(const SuiteTable& table) {
  return section_html(table.id, table.title, escape_html(table.note), table_html(table));
}

std::string list_html(const std::vector<std::string>& items) {
  std::string html = "<ul>\n";
  for (const std::string& item : items) html += fmt::format("<li>{}</li>\n", escape_html(item));
  return html + "</ul>\n";
}

std::vector<std::string> problems(const SuiteFigures& figures) {
  std::vector<std::string> list;
  for (const RunFigures& r : figures.runs()) {
    const std::string name = fmt::format("{} {} seed {}", figures.plan().scenarios[r.run.scenario].name,
                                         method_name(r.run.method), r.run.seed);
    if (!r.failure.empty()) list.push_back(fmt::format("{}: {}", name, r.failure));
    if (!r.worthless.empty()) list.push_back(fmt::format("{}: worthless: {}", name, r.worthless));
    for (const std::string& failed : r.failed_expectations)
      list.push_back(fmt::format("{}: {}", name, failed));
  }
  return list;
}

std::string verdict(const SuiteFigures& figures) {
  const bool good = figures.as_expected();
  std::string html = fmt::format(
      "<p class=\"verdict\"><span class=\"chip {}\">{}</span> {} of {} runs: {} scenarios, {} methods, {} "
      "seeds.{}</p>",
      good ? "good" : "bad", good ? "as expected" : "not as expected", figures.present(),
      figures.runs().size(), figures.plan().scenarios.size(), figures.plan().methods.size(),
      figures.plan().suite.seeds.size(),
      figures.builds() > 1 ? fmt::format(" Made by {} different builds.", figures.builds()) : "");
  if (!figures.plan().suite.description.empty())
    html += fmt::format("<p class=\"lead\">{}</p>\n", escape_html(figures.plan().suite.description));
  return html;
}

std::string expectations_html(const SuiteFigures& figures) {
  std::string rows;
  for (const SuiteFigures::Expected& e : figures.expected())
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"text\">{}</td><td>{}</td><td>{}</td><td><span class=\"chip "
        "{}\">{}</span></td></tr>\n",
        escape_html(e.result.metric), method_name(e.method),
        e.result.value ? fmt::format("{:.6g}", *e.result.value) : "–", escape_html(e.result.bound.text()),
        e.result.pass ? "good" : "bad", e.result.pass ? "pass" : "fail");
  if (rows.empty()) return rows;
  return "<div class=\"scroll\"><table class=\"figures\">\n<thead><tr><th scope=\"col\" class=\"text\">Mean "
         "of</th><th scope=\"col\" class=\"text\">Method</th><th scope=\"col\">Value</th><th "
         "scope=\"col\">Bound</th><th scope=\"col\">Result</th></tr></thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string offsets_table(const std::vector<MethodOffsets>& offsets) {
  if (offsets.empty()) return {};
  std::string html = "<div class=\"scroll\"><table class=\"figures suite\">\n<thead><tr><td></td>";
  for (const OffsetBin& bin : offsets.front().bins)
    html += fmt::format("<th scope=\"col\">{} to {} m</th>", bin.low_m, bin.high_m);
  html += "</tr></thead>\n<tbody>\n";
  for (const MethodOffsets& of : offsets) {
    html += fmt::format("<tr><th scope=\"row\">{}</th>", method_name(of.method));
    for (const OffsetBin& bin : of.bins)
      html += bin.revisits == 0
                  ? "<td><span class=\"none\">–</span></td>"
                  : fmt::format("<td>{:.2f}<small> {} of {}</small></td>",
                                static_cast<double>(bin.closed) / bin.revisits, bin.closed, bin.revisits);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// Means over all runs of a method.
struct MethodTiming {
  double real_time_factor = 0, peak_rss_mib = 0, median_ms = 0, p99_ms = 0;
  int runs = 0;
};

std::map<Method, MethodTiming> timings(const SuiteFigures& figures) {
  std::map<Method, MethodTiming> all;
  for (const RunFigures& r : figures.runs()) {
    const auto path = r.run.folder / "timing.json";
    if (!r.present || !std::filesystem::exists(path)) continue;
    const json timing = json::parse(read_file(path), nullptr, false);
    if (!timing.is_object()) continue;
    MethodTiming& sum = all[r.run.method];
    ++sum.runs;
    sum.real_time_factor += timing.value("real_time_factor", 0.0);
    sum.peak_rss_mib = std::max(sum.peak_rss_mib, timing.value("peak_rss_mib", 0.0));
    const json scan = timing.value("stages", json::object()).value("slam_scan", json::object());
    sum.median_ms += scan.value("median_ms", 0.0);
    sum.p99_ms += scan.value("p99_ms", 0.0);
  }
  return all;
}

std::string timing_html(const SuiteFigures& figures) {
  std::string rows;
  for (const auto& [method, sum] : timings(figures))
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{:.1f}</td><td>{:.2f}</td><td>{:.1f}</td><td>{:.0f}</td></tr>\n",
        method_name(method), sum.real_time_factor / sum.runs, sum.median_ms / sum.runs, sum.p99_ms / sum.runs,
        sum.peak_rss_mib);
  if (rows.empty()) return rows;
  return section_html(
      "timing", "Timing",
      "Wall clock; the only part of this page that differs from time to time. The real-time factor is of a "
      "whole "
      "seed, all methods at once, beside others that ran at the same time; times per scan are of the "
      "estimator, loop "
      "closing included; the peak of memory is of the process until then. Every stage stands in timing.csv.",
      "<div class=\"scroll\"><table class=\"figures suite\">\n<thead><tr><td></td><th scope=\"col\">× real "
      "time</th><th scope=\"col\">scan, median (ms)</th><th scope=\"col\">scan, 99th percentile (ms)</th><th "
      "scope=\"col\">peak memory (MiB)</th></tr></thead>\n<tbody>\n" +
          rows + "</tbody></table></div>\n");
}

}  // namespace

std::string suite_page(const SuiteFigures& figures, const std::vector<MethodOffsets>& offsets) {
  const Suite& suite = figures.plan().suite;
  std::map<std::string, std::string> sections;
  for (const SuiteTable& table : suite_tables(figures)) sections[table.id] = table_section(table);
  const std::vector<std::string> behind = losses(figures), bad = problems(figures);
  return fill_page(
      k_page_suite_html,
      {{"title", escape_html("Suite " + suite.name)},
       {"style", std::string(k_page_css) + std::string(k_page_suite_css)},
       {"verdict", verdict(figures)},
       {"reference", suite.reference.figures.empty()
                         ? ""
                         : fmt::format("<p class=\"note\">The small figure below ours: {}.</p>",
                                       escape_html(suite.reference.source))},
       {"problems",
        section_html("problems", "Runs that failed, are missing, worthless or miss an expectation", "",
                     bad.empty() ? "" : list_html(bad))},
       {"behind", section_html("behind", "Where " + escape_html(suite.focus) + " is behind",
                               "By the means over seeds, to the digits shown.",
                               !has_focus(figures) ? ""
                               : behind.empty()    ? "<p>Nowhere.</p>\n"
                                                   : list_html(behind))},
       {"error", sections["error"]},
       {"memory", sections["memory"] + sections["database"]},
       {"loops", sections["loops"] + sections["recall"] + sections["precision"]},
       {"sequences", sections["health"] + sections["sequences"]},
       {"offsets_table", offsets_table(offsets)},
       {"expectations",
        section_html("expectations", "Expectations of the suite", "", expectations_html(figures))},
       {"timing", timing_html(figures)},
       {"data", suite_drawings(figures, offsets)},
       {"script", std::string(k_page_chart_js) + std::string(k_page_suite_js)}});
}

}  // namespace vsslam

#include "scenarios/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/files.h"
#include "report_page.h"
#include "scenarios/report/base64.h"
#include "scenarios/report/page_data.h"
#include "scenarios/report/page_health.h"
#include "scenarios/report/page_tables.h"
#include "scenarios/report/page_template.h"
#include "scenarios/report/stored_result.h"

namespace vsslam {

namespace {

std::string title_of(std::span<const StoredResult> results) {
  if (results.size() == 1) return results[0].name();
  std::set<std::string> scenarios;
  for (const StoredResult& result : results) scenarios.insert(result.scenario);
  std::string title;
  for (const std::string& scenario : scenarios) title += (title.empty() ? "" : ", ") + scenario;
  return fmt::format("{} · {} results", title, results.size());
}

std::string figures(std::span<const StoredResult> results) {
  return fmt::format(
      "<section id=\"figures\">\n<h2>All figures</h2>\n<div class=\"groups {}\">\n{}{}</div>\n</section>",
      results.size() == 1 ? "one" : "many", metrics_html(results), expectations_html(results));
}

std::string camera_html(const StoredResult& result) {
  if (result.camera_png.empty()) return {};
  return fmt::format("<img alt=\"camera images\" style=\"width:100%\" src=\"data:image/png;base64,{}\">\n",
                     base64(result.camera_png));
}

constexpr const char* kAligned =
    "Estimate and odometry are each aligned to the truth (SE(3), least squares over all poses). Loops are "
    "drawn "
    "between true places: a\ntrue one is short, a false one joins places that are apart.";
constexpr const char* kNotAligned =
    "There is no truth: estimate and odometry begin at the same pose, and loops are drawn between estimated "
    "places.";

std::string page(std::span<const StoredResult> results) {
  const bool alone = results.size() == 1;
  const bool truth =
      std::any_of(results.begin(), results.end(), [](const StoredResult& r) { return r.has_truth(); });
  return fill_page(
      k_page_html,
      {{"title", escape_html(title_of(results))},
       {"style", std::string(k_page_css)},
       {"verdict", verdict_html(results) + health_verdict_html(results)},
       {"headline", alone ? headline_html(results[0]) : ""},
       {"figures_above", alone ? "" : figures(results)},
       {"figures_below", alone ? figures(results) : ""},
       {"trajectories_note", truth ? kAligned : kNotAligned},
       {"error_hidden", truth ? "" : " hidden"},
       {"health",
        section_html("health", "Health", "How the sensors and the odometry fared, without any truth.",
                     health_html(results))},
       {"camera", section_html("camera", "What the camera saw",
                               "Images spread over the run, half their size, row by row.",
                               alone ? camera_html(results[0]) : "")},
       {"loops",
        section_html("loops", "Loop candidates",
                     fmt::format("Every candidate, accepted or not{}. Point at a row to see it on the map.",
                                 truth ? ", judged against exact truth" : ""),
                     loops_html(results))},
       {"timing",
        section_html("timing", "Timing", "Wall clock; the only part of this page that differs between runs.",
                     timing_html(results))},
       {"data", page_data(results)},
       {"script", std::string(k_page_chart_js) + std::string(k_page_map_js) + std::string(k_page_js)}});
}

}  // namespace

void write_report(const std::filesystem::path& result_dir) {
  const StoredResult result = read_stored_result(result_dir);
  write_file(result_dir / "report.html", page({&result, 1}));
}

void write_comparison(std::span<const std::filesystem::path> result_dirs, const std::filesystem::path& html) {
  if (result_dirs.empty()) throw InputError("a report needs at least one result folder");
  std::vector<StoredResult> results;
  for (const auto& dir : result_dirs) results.push_back(read_stored_result(dir));
  write_file(html, page(results));
}

}  // namespace vsslam

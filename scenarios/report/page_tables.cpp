#include "scenarios/report/page_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/errors.h"
#include "scenarios/report/page_health.h"

namespace vsslam {

namespace {

using nlohmann::json;

enum class Better { none, low, high };

struct Figure {
  const char* pointer;  ///< JSON pointer into metrics.json
  const char* label;
  const char* unit;
  int decimals;
  Better better = Better::none;
};

struct Group {
  const char* title;
  std::vector<Figure> figures;
};

const std::vector<Group>& groups() {
  static const std::vector<Group> kGroups = {
      {"Accuracy",
       {{"/ate_rmse_m", "ATE RMSE", "m", 3, Better::low},
        {"/ate_max_m", "ATE maximum", "m", 3, Better::low},
        {"/end_error_m", "End error", "m", 3, Better::low},
        {"/rpe_10m_percent", "RPE over 10 m, translation", "%", 3, Better::low},
        {"/rpe_10m_deg", "RPE over 10 m, rotation", "°", 3, Better::low},
        {"/odometry_ate_rmse_m", "Odometry ATE RMSE", "m", 3, Better::low},
        {"/odometry_nees", "Odometry NEES per dimension", "", 2},
        {"/vio_ate_rmse_m", "VIO ATE RMSE", "m", 3, Better::low},
        {"/map_error_mean_m", "Map to surface, mean", "m", 3, Better::low},
        {"/coverage", "Scans with truth", "", 3, Better::high}}},
      {"Loops",
       {{"/loops/candidates", "Candidates", "", 0},
        {"/loops/accepted", "Accepted", "", 0},
        {"/loops/true", "True", "", 0, Better::high},
        {"/loops/false", "False", "", 0, Better::low},
        {"/loops/revisits", "Revisits", "", 0},
        {"/loops/recall", "Recall", "", 3, Better::high},
        {"/loops/precision", "Precision", "", 3, Better::high}}},
      {"Memory",
       {{"/descriptors/count", "Stored descriptors", "", 0, Better::low},
        {"/descriptors/index_bytes", "Index", "B", 0, Better::low},
        {"/descriptors/descriptor_bytes", "Descriptors", "B", 0, Better::low},
        {"/descriptors/database_bytes", "Whole database", "B", 0, Better::low}}},
      {"Degeneracy",
       {{"/degeneracy/precision", "Detector precision", "", 3, Better::high},
        {"/degeneracy/recall", "Detector recall", "", 3, Better::high},
        {"/degeneracy/direction_error_deg_median", "Direction error, median", "°", 2, Better::low}}},
      {"Drive",
       {{"/duration_s", "Duration", "s", 1},
        {"/path_length_m", "Path length", "m", 1},
        {"/scans", "Scans", "", 0},
        {"/images", "Images", "", 0},
        {"/restarts", "Restarts", "", 0, Better::low},
        {"/health/scans_prior_only", "Scans without the LiDAR", "", 0, Better::low},
        {"/health/scans_unconverged", "Scans not converged", "", 0, Better::low}}},
  };
  return kGroups;
}

std::optional<double> number_at(const json& object, const char* pointer) {
  const json::json_pointer at(pointer);
  if (!object.contains(at) || !object.at(at).is_number()) return std::nullopt;
  return object.at(at).get<double>();
}

/// With thin spaces between groups of three digits. Small values get more decimals, for two significant digits.
std::string number_html(std::optional<double> value, int decimals) {
  if (!value) return "<span class=\"none\">–</span>";
  for (int more = 0;
       decimals > 0 && more < 2 && *value != 0 && std::abs(*value) * std::pow(10, decimals) < 10; ++more)
    ++decimals;
  std::string text = fmt::format("{:.{}f}", *value, decimals);
  const size_t whole = std::min(text.find('.'), text.size());
  const size_t first = text[0] == '-' ? 1 : 0;
  for (size_t at = whole; at > first + 3; at -= 3) text.insert(at - 3, "\u2009");
  return text;
}

std::optional<double> best_of(const std::vector<std::optional<double>>& values, Better better) {
  std::optional<double> best;
  if (better == Better::none || values.size() < 2) return best;
  for (const auto& value : values)
    if (value && (!best || (better == Better::low ? *value < *best : *value > *best))) best = value;
  // Equal everywhere: nothing stands out.
  if (std::all_of(values.begin(), values.end(), [&](const auto& value) { return value == best; }))
    best.reset();
  return best;
}

const char* blind_mark(const StoredResult& result, const Figure& figure) {
  return figure.pointer == std::string_view("/ate_rmse_m") && lidar_blind(result)
             ? " <span class=\"chip bad\">!</span>"
             : "";
}

std::string figure_row(std::span<const StoredResult> results, const Figure& figure) {
  std::vector<std::optional<double>> values;
  for (const StoredResult& result : results) values.push_back(number_at(*result.metrics, figure.pointer));
  if (std::none_of(values.begin(), values.end(), [](const auto& value) { return value.has_value(); }))
    return {};
  std::vector<std::optional<double>> comparable = values;
  for (size_t i = 0; i < results.size(); ++i)
    if (lidar_blind(results[i])) comparable[i].reset();
  const auto best = best_of(comparable, figure.better);
  std::string row = fmt::format("<tr><th scope=\"row\">{}</th>", figure.label);
  for (size_t i = 0; i < results.size(); ++i)
    row += fmt::format("<td{}>{}{}</td>", best && comparable[i] == best ? " class=\"best\"" : "",
                       number_html(values[i], figure.decimals), blind_mark(results[i], figure));
  return row + fmt::format("<td class=\"unit\">{}</td></tr>\n", figure.unit);
}

std::string column_heads(std::span<const StoredResult> results) {
  std::string heads;
  for (const StoredResult& result : results)
    heads += fmt::format("<th scope=\"col\">{}<small>{}{}</small></th>", escape_html(result.method),
                         escape_html(result.scenario),
                         result.seed.empty() ? "" : " · seed " + escape_html(result.seed));
  return heads;
}

std::string json_text(const json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_string()) return escape_html(value.get<std::string>());
  return escape_html(value.dump(-1, ' ', false, json::error_handler_t::replace));
}

struct Expectation {
  std::string name, value, bound;
  bool pass = false;
};

std::vector<Expectation> expectations_of(const StoredResult& result) {
  std::vector<Expectation> expectations;
  const json all = result.metrics->value("expectations", json::object());
  if (!all.is_object())
    throw InputError(
        fmt::format("{}: \"expectations\": expected an object", (result.path / "metrics.json").string()));
  for (const auto& [name, expectation] : all.items()) {
    if (!expectation.is_object() || !expectation.contains("pass") || !expectation["pass"].is_boolean())
      throw InputError(fmt::format("{}: expectation \"{}\": expected value, bound and pass",
                                   (result.path / "metrics.json").string(), name));
    expectations.push_back({name, json_text(expectation.value("value", json())),
                            json_text(expectation.value("bound", json())), expectation["pass"].get<bool>()});
  }
  return expectations;
}

std::string expectation_rows(const StoredResult& result, bool with_name) {
  std::string rows;
  for (const auto& [name, value, bound, pass] : expectations_of(result))
    rows += fmt::format(
        "<tr>{}<th scope=\"row\">{}</th><td>{}</td><td>{}</td><td><span class=\"chip "
        "{}\">{}</span></td></tr>\n",
        with_name ? fmt::format("<td class=\"text\">{}</td>", escape_html(result.name())) : "",
        escape_html(name), value, bound, pass ? "good" : "bad", pass ? "pass" : "fail");
  return rows;
}

struct LoopColumn {
  const char* column;
  const char* label;
  int decimals;  ///< -1: as it is
};

constexpr LoopColumn kShownLoopColumns[] = {
    {"query", "Query", -1},
    {"match", "Match", -1},
    {"query_stamp", "Time (s)", 1},
    {"descriptor_distance", "Distance", 3},
    {"runner_up_distance", "Runner-up", 3},
    {"virtual_id", "Virtual", -1},
    {"yaw_rad", "Yaw (rad)", 2},
    {"icp_iterations", "ICP steps", -1},
    {"fitness_m2", "Fitness (m²)", 4},
    {"inlier_ratio", "Inliers", 2},
    {"overlap", "Overlap", 2},
    {"true_overlap", "True overlap", 2},
    {"true_error_m", "Error (m)", 3},
    {"true_error_deg", "Error (°)", 2},
};

std::string loop_row(const CsvTable& loops, size_t row) {
  const std::string& judged = loops.text(row, "verdict");
  const std::string verdict = judged.empty() ? "accepted" : judged;
  const char* tone = verdict == "true" ? "good" : verdict == "false" ? "bad" : "quiet";
  std::string html = fmt::format(
      "<tr data-row=\"{}\" data-verdict=\"{}\"><td class=\"text\"><span class=\"chip {}\">{}"
      "</span></td><td class=\"text\">{}</td>",
      row, escape_html(verdict), tone, escape_html(verdict), escape_html(loops.text(row, "why")));
  for (const auto& [column, label, decimals] : kShownLoopColumns)
    html += fmt::format("<td>{}</td>", decimals < 0 ? escape_html(loops.text(row, column))
                                                    : number_html(loops.maybe_number(row, column), decimals));
  return html + "</tr>\n";
}

std::string tile(const Figure& figure, double value, const char* mark = "") {
  return fmt::format("<div class=\"tile\"><dt>{}</dt><dd>{}<span class=\"unit\">{}</span>{}</dd></div>\n",
                     figure.label, number_html(value, figure.decimals), figure.unit, mark);
}

std::string timing_tiles(const json& timing) {
  constexpr Figure kWhole[] = {{"/real_time_factor", "Real-time factor", "×", 1},
                               {"/peak_rss_mib", "Peak memory", "MiB", 0},
                               {"/cores", "Cores", "", 0}};
  std::string tiles;
  for (const Figure& figure : kWhole)
    if (const auto value = number_at(timing, figure.pointer)) tiles += tile(figure, *value);
  return tiles;
}

std::string stage_rows(const json& stages) {
  std::string rows;
  for (const auto& [name, stage] : stages.items())
    rows +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                    escape_html(name), number_html(number_at(stage, "/median_ms"), 3),
                    number_html(number_at(stage, "/p99_ms"), 3), number_html(number_at(stage, "/count"), 0));
  return rows;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string verdict_html(std::span<const StoredResult> results) {
  size_t all = 0, failed = 0;
  for (const StoredResult& result : results)
    for (const Expectation& expectation : expectations_of(result)) {
      ++all;
      failed += !expectation.pass;
    }
  if (all == 0) return {};
  if (failed == 0) return "<p class=\"verdict\"><span class=\"chip good\">every expectation met</span></p>";
  return fmt::format("<p class=\"verdict\"><span class=\"chip bad\">{} of {} expectations failed</span></p>",
                     failed, all);
}

std::string headline_html(const StoredResult& result) {
  constexpr Figure kTiles[] = {
      {"/ate_rmse_m", "ATE RMSE", "m", 3},           {"/end_error_m", "End error", "m", 3},
      {"/rpe_10m_percent", "RPE over 10 m", "%", 2}, {"/odometry_ate_rmse_m", "Odometry ATE", "m", 3},
      {"/map_error_mean_m", "Map error", "m", 3},    {"/loops/recall", "Loop recall", "", 2},
      {"/loops/precision", "Loop precision", "", 2}, {"/descriptors/count", "Descriptors", "", 0}};
  std::string tiles;
  for (const Figure& figure : kTiles)
    if (const auto value = number_at(*result.metrics, figure.pointer))
      tiles += tile(figure, *value, blind_mark(result, figure));
  return tiles.empty() ? tiles : "<dl class=\"tiles\">\n" + tiles + "</dl>\n";
}

std::string metrics_html(std::span<const StoredResult> results) {
  const bool alone = results.size() == 1;
  std::string html;
  for (const Group& group : groups()) {
    std::string rows;
    for (const Figure& figure : group.figures) rows += figure_row(results, figure);
    if (rows.empty()) continue;
    if (alone)
      html += fmt::format(
          "<div class=\"scroll\"><table "
          "class=\"figures\"><caption>{}</caption>\n<tbody>\n{}</tbody></table></div>\n",
          group.title, rows);
    else
      html += fmt::format("<tbody>\n<tr><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n{}</tbody>\n",
                          results.size() + 2, group.title, rows);
  }
  if (alone) return html;
  return fmt::format(
      "<div class=\"scroll\"><table class=\"figures\">\n<thead><tr><td></td>{}<td></td></tr></thead>\n{}"
      "</table></div>\n",
      column_heads(results), html);
}

std::string expectations_html(std::span<const StoredResult> results) {
  std::string rows;
  for (const StoredResult& result : results) rows += expectation_rows(result, results.size() > 1);
  if (rows.empty()) return {};
  return fmt::format(
      "<div class=\"scroll\"><table class=\"figures\"><caption>Expectations</caption>\n<thead><tr>{}<th "
      "scope=\"col\">"
      "Figure</th><th scope=\"col\">Value</th><th scope=\"col\">Bound</th><th "
      "scope=\"col\">Result</th></tr></thead>\n"
      "<tbody>\n{}</tbody></table></div>\n",
      results.size() > 1 ? "<th scope=\"col\" class=\"text\">Result of</th>" : "", rows);
}

std::string loops_html(std::span<const StoredResult> results) {
  std::string html, heads;
  for (const LoopColumn& column : kShownLoopColumns)
    heads += fmt::format("<th scope=\"col\">{}</th>", column.label);
  for (size_t i = 0; i < results.size(); ++i) {
    if (!results[i].loops || results[i].loops->rows() == 0) continue;
    std::string rows;
    for (size_t row = 0; row < results[i].loops->rows(); ++row) rows += loop_row(*results[i].loops, row);
    html += fmt::format(
        "<div class=\"scroll tall\" data-run=\"{}\"><table "
        "class=\"loops\"><caption>{}</caption>\n<thead><tr><th "
        "scope=\"col\">Verdict</th><th "
        "scope=\"col\">Why</th>{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
        i, escape_html(results[i].name()), heads, rows);
  }
  return html;
}

std::string timing_html(std::span<const StoredResult> results) {
  std::string html;
  for (const StoredResult& result : results) {
    if (!result.timing) continue;
    html += fmt::format("<h3>{}</h3>\n<dl class=\"tiles\">\n{}</dl>\n", escape_html(result.name()),
                        timing_tiles(*result.timing));
    const std::string rows = stage_rows(result.timing->value("stages", json::object()));
    if (!rows.empty())
      html +=
          "<div class=\"scroll\"><table class=\"figures\"><caption>Stages</caption>\n<thead><tr><th "
          "scope=\"col\" "
          "class=\"text\">Stage</th><th scope=\"col\">Median (ms)</th><th scope=\"col\">99th percentile "
          "(ms)</th><th "
          "scope=\"col\">Count</th></tr></thead>\n<tbody>\n" +
          rows + "</tbody></table></div>\n";
  }
  return html;
}

}  // namespace vsslam

#include "scenarios/report/page_health.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/health/health.h"
#include "scenarios/report/page_tables.h"

namespace vsslam {

namespace {

using nlohmann::json;

json member(const json& object, const char* key) {
  return object.is_object() ? object.value(key, json()) : json();
}

json health_of(const StoredResult& result) {
  return member(*result.metrics, "health");
}

std::string text_of(const json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::string number(const json& value, int decimals, const char* unit) {
  if (!value.is_number()) return {};
  return fmt::format("{:.{}f}{}{}", value.get<double>(), decimals, *unit == 0 ? "" : " ", unit);
}

/// "gravity 9.81 m/s², tilt 0.2°" of the figures that are there.
struct Fact {
  const char *key, *label;
  int decimals;
  const char* unit;
};
constexpr Fact kFacts[] = {{"gravity_mps2", "gravity", 2, "m/s²"},
                           {"gravity_tilt_deg", "off the vertical", 1, "°"},
                           {"gyro_scale", "gyroscope by LiDAR", 3, ""},
                           {"gyro_correlation", "their correlation", 3, ""},
                           {"travel_scale", "travel by LiDAR", 3, ""},
                           {"yaw_scale", "turning by LiDAR", 3, ""},
                           {"points_mean", "points per scan", 0, ""},
                           {"without_points", "without points", 0, ""},
                           {"grey_mean", "mean grey", 0, "of 255"},
                           {"dark", "dark", 0, ""},
                           {"frozen", "frozen", 0, ""}};

std::string facts(const json& sensor) {
  std::string text;
  for (const auto& [key, label, decimals, unit] : kFacts)
    if (const std::string value = number(member(sensor, key), decimals, unit); !value.empty())
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", label, value);
  return text;
}

std::string dropped(const json& sensor) {
  int64_t sum = 0;
  std::string reasons;
  const json by_reason = member(sensor, "dropped");
  if (by_reason.is_object())
    for (const auto& [reason, count] : by_reason.items()) {
      if (!count.is_number_integer()) continue;
      sum += count.get<int64_t>();
      reasons +=
          fmt::format("{}{} {}", reasons.empty() ? "" : ", ", escape_html(reason), count.get<int64_t>());
    }
  return reasons.empty() ? "0" : fmt::format("{} <small>{}</small>", sum, reasons);
}

std::string or_dash(const std::string& text) {
  return text.empty() ? "<span class=\"none\">–</span>" : text;
}

std::string gap(const json& sensor) {
  const std::string length = number(member(sensor, "longest_gap_s"), 2, "");
  const std::string at = number(member(sensor, "longest_gap_at_s"), 1, "s");
  return length.empty() ? length : fmt::format("{} <small>after {}</small>", length, at);
}

std::string share(const json& sensor) {
  const json value = member(sensor, "share_of_time");
  return value.is_number() ? fmt::format("{:.0f} %", 100 * value.get<double>()) : std::string();
}

std::string sensors_table(const json& sensors) {
  if (!sensors.is_object() || sensors.empty()) return {};
  std::string rows;
  for (const auto& [name, sensor] : sensors.items())
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td "
        "class=\"text\">{}</td></tr>\n",
        escape_html(name), or_dash(number(member(sensor, "used"), 0, "")), dropped(sensor),
        or_dash(number(member(sensor, "rate_hz"), 1, "")), or_dash(share(sensor)), or_dash(gap(sensor)),
        facts(sensor));
  return "<div class=\"scroll\"><table class=\"figures\">\n<thead><tr><th scope=\"col\" "
         "class=\"text\">Sensor</th><th scope=\"col\">Used</th><th scope=\"col\">Dropped</th><th "
         "scope=\"col\">Rate (Hz)</th><th scope=\"col\">Of the time</th><th scope=\"col\">Longest gap "
         "(s)</th><th scope=\"col\" class=\"text\">Found</th></tr></thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string list(const char* chip, const char* tone, const json& lines) {
  std::string html;
  if (!lines.is_array()) return html;
  for (const json& line : lines)
    html += fmt::format("<li><span class=\"chip {}\">{}</span> {}</li>\n", tone, chip,
                        escape_html(text_of(line)));
  return html;
}

std::string lost(const json& spans) {
  std::string html;
  if (!spans.is_array()) return html;
  for (const json& span : spans)
    html += fmt::format("<li><span class=\"chip bad\">lost</span> {} to {}, {} scans: {}</li>\n",
                        number(member(span, "begin_s"), 1, "s"), number(member(span, "end_s"), 1, "s"),
                        number(member(span, "scans"), 0, ""), escape_html(text_of(member(span, "why"))));
  return html;
}

std::string scans_line(const StoredResult& result, const json& health) {
  const auto count = [&](const char* key) { return or_dash(number(member(health, key), 0, "")); };
  return fmt::format(
      "<p class=\"note\">Scans: {}. The LiDAR gave nothing in {}, saw one direction worse than 5 cm in {}; {} did not "
      "converge; in {} the wheels' way was not the IMU's; in {} the prior was not believed. Steps known no better than 10 cm: "
      "{} of {}.</p>\n",
      or_dash(number(member(*result.metrics, "scans"), 0, "")), count("scans_prior_only"), count("scans_blind"),
      count("scans_unconverged"), count("wheels_slipped"), count("prior_refused"), count("steps_unsure"), count("steps"));
}

std::string one_html(const StoredResult& result, bool named) {
  const json health = health_of(result);
  if (!health.is_object()) return {};
  std::string items;
  if (const std::string why = text_of(member(health, "worthless")); !why.empty())
    items += fmt::format("<li><span class=\"chip bad\">worthless</span> {}</li>\n", escape_html(why));
  items += list("warning", "bad", member(health, "warnings")) + lost(member(health, "lost_spans")) +
           list("set right or assumed", "quiet", member(health, "repairs"));
  return (named ? fmt::format("<h3>{}</h3>\n", escape_html(result.name())) : "") +
         (items.empty() ? "" : "<ul class=\"health\">\n" + items + "</ul>\n") + scans_line(result, health) +
         sensors_table(member(health, "sensors"));
}

}  // namespace

bool lidar_blind(const StoredResult& result) {
  const json health = health_of(result);
  if (member(health, "worthless").is_string()) return true;
  const json without = member(health, "scans_prior_only"), scans = member(*result.metrics, "scans");
  return without.is_number() && scans.is_number() &&
         without.get<double>() > kBlindShare * scans.get<double>();
}

std::string health_verdict_html(std::span<const StoredResult> results) {
  size_t worthless = 0, warnings = 0, known = 0;
  for (const StoredResult& result : results) {
    const json health = health_of(result);
    if (!health.is_object()) continue;
    ++known;
    worthless += member(health, "worthless").is_string();
    warnings += member(health, "warnings").size();
  }
  if (known == 0) return {};
  if (worthless > 0)
    return results.size() == 1
               ? fmt::format("<p class=\"verdict\"><span class=\"chip bad\">worthless</span> {}</p>",
                             escape_html(text_of(member(health_of(results[0]), "worthless"))))
               : fmt::format(
                     "<p class=\"verdict\"><span class=\"chip bad\">{} of {} results are "
                     "worthless</span></p>",
                     worthless, results.size());
  if (warnings == 0) return "<p class=\"verdict\"><span class=\"chip good\">sensors healthy</span></p>";
  return fmt::format(
      "<p class=\"verdict\"><span class=\"chip bad\">{} warning{}</span> <a href=\"#health\">of the "
      "sensors</a></p>",
      warnings, warnings == 1 ? "" : "s");
}

std::string health_html(std::span<const StoredResult> results) {
  std::string html;
  for (const StoredResult& result : results) html += one_html(result, results.size() > 1);
  return html;
}

}  // namespace vsslam

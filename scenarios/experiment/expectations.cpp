#include "scenarios/experiment/expectations.h"

#include <fmt/format.h>

#include <algorithm>

#include "slam/loop/loop_config.h"

namespace vsslam {

void Bound::fields(Fields& f) {
  f("min", min);
  f("max", max);
  f.check(min.has_value() || max.has_value(), "max", "min, max or both");
}

bool Bound::holds(double value) const {
  return (!min || value >= *min) && (!max || value <= *max) && value == value;
}

std::string Bound::text() const {
  if (min && max) return fmt::format("{} to {}", *min, *max);
  return min ? fmt::format(">= {}", *min) : fmt::format("<= {}", max.value_or(0));
}

const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = {"duration_s",
                                                 "path_length_m",
                                                 "scans",
                                                 "images",
                                                 "ate_rmse_m",
                                                 "ate_max_m",
                                                 "rpe_10m_percent",
                                                 "rpe_10m_deg",
                                                 "end_error_m",
                                                 "odometry_ate_rmse_m",
                                                 "odometry_nees",
                                                 "vio_ate_rmse_m",
                                                 "map_error_mean_m",
                                                 "descriptors.count",
                                                 "descriptors.index_bytes",
                                                 "descriptors.descriptor_bytes",
                                                 "descriptors.database_bytes",
                                                 "loops.candidates",
                                                 "loops.accepted",
                                                 "loops.true",
                                                 "loops.false",
                                                 "loops.revisits",
                                                 "loops.recall",
                                                 "loops.precision",
                                                 "loops.aliases",
                                                 "degeneracy.precision",
                                                 "degeneracy.recall",
                                                 "degeneracy.direction_error_deg_median",
                                                 "restarts",
                                                 "coverage",
                                                 "health.scans_prior_only",
                                                 "health.scans_blind",
                                                 "health.steps_unsure",
                                                 "health.scans_unconverged",
                                                 "health.lost_spans",
                                                 "health.warnings"};
  return names;
}

namespace {

std::string did_you_mean(const std::string& word, const std::vector<std::string>& words) {
  const std::string near = nearest(word, words);
  return near.empty() ? "" : fmt::format(" (did you mean {}?)", near);
}

}  // namespace

void expectation_fields(Fields& f, Expectations& expect) {
  f("expect", expect);
  std::vector<std::string> who = {"all"};
  for (const Method method : all_methods()) who.emplace_back(method_name(method));
  for (const auto& [method, bounds] : expect) {
    f.check(std::find(who.begin(), who.end(), method) != who.end(), "expect",
            fmt::format("\"all\" or the name of a method, got \"{}\"{}", method, did_you_mean(method, who)));
    for (const auto& [metric, bound] : bounds)
      f.check(std::find(metric_names().begin(), metric_names().end(), metric) != metric_names().end(),
              "expect",
              fmt::format("names of metrics, got \"{}\"{}", metric, did_you_mean(metric, metric_names())));
  }
}

MetricBounds bounds_for(const Expectations& expect, const std::string& method) {
  MetricBounds bounds;
  if (const auto own = expect.find(method); own != expect.end()) bounds = own->second;
  if (const auto all = expect.find("all"); all != expect.end())
    bounds.insert(all->second.begin(), all->second.end());
  return bounds;
}

}  // namespace vsslam

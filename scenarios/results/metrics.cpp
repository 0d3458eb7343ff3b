#include "scenarios/results/metrics.h"

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

namespace vsslam {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json all_figures(const Metrics& m) {
  return {{"scenario", m.scenario},
          {"method", m.method},
          {"seed", m.seed ? Json(*m.seed) : Json(nullptr)},
          {"failure", m.failure.empty() ? Json(nullptr) : Json(m.failure)},
          {"duration_s", m.duration_s},
          {"path_length_m", m.path_length_m},
          {"scans", m.scans},
          {"images", m.images},
          {"ate_rmse_m", number(m.ate_rmse_m)},
          {"ate_max_m", number(m.ate_max_m)},
          {"rpe_10m_percent", number(m.rpe_10m_percent)},
          {"rpe_10m_deg", number(m.rpe_10m_deg)},
          {"end_error_m", number(m.end_error_m)},
          {"odometry_ate_rmse_m", number(m.odometry_ate_rmse_m)},
          {"odometry_nees", number(m.odometry_nees)},
          {"vio_ate_rmse_m", number(m.vio_ate_rmse_m)},
          {"map_error_mean_m", number(m.map_error_mean_m)},
          {"coverage", number(m.coverage)},
          {"descriptors",
           {{"count", m.descriptors.count},
            {"index_bytes", m.descriptors.index_bytes},
            {"descriptor_bytes", m.descriptors.descriptor_bytes},
            {"database_bytes", m.descriptors.database_bytes}}},
          {"loops",
           {{"candidates", m.loops.candidates},
            {"accepted", m.loops.accepted},
            {"true", m.loops.true_loops},
            {"false", m.loops.false_loops},
            {"revisits", m.loops.revisits},
            {"recall", number(m.loops.recall)},
            {"precision", number(m.loops.precision)},
            {"aliases", m.loops.aliases}}},
          {"degeneracy",
           {{"precision", number(m.degeneracy.precision)},
            {"recall", number(m.degeneracy.recall)},
            {"direction_error_deg_median", number(m.degeneracy.direction_error_deg_median)}}},
          {"restarts", m.restarts},
          {"health", health_json(m.health, m.stamp_offset)}};
}

void erase(Json& json, std::initializer_list<const char*> keys) {
  for (const char* key : keys) json.erase(key);
}

Json to_json(const Metrics& m) {
  Json json = all_figures(m);
  if (!m.seed) json.erase("seed");
  if (m.truth == Truth::world) return json;
  erase(json, {"map_error_mean_m", "degeneracy"});
  erase(json["loops"], {"revisits", "recall", "aliases"});
  if (m.truth == Truth::trajectory) return json;
  erase(json, {"path_length_m", "ate_rmse_m", "ate_max_m", "rpe_10m_percent", "rpe_10m_deg", "end_error_m",
               "odometry_ate_rmse_m", "odometry_nees", "vio_ate_rmse_m", "coverage"});
  erase(json["loops"], {"true", "false", "precision"});
  return json;
}

std::optional<double> find(const Json& json, const std::string& metric) {
  const Json* node = &json;
  for (size_t begin = 0; begin <= metric.size();) {
    const size_t end = std::min(metric.find('.', begin), metric.size());
    const std::string key = metric.substr(begin, end - begin);
    if (!node->is_object() || !node->contains(key)) return std::nullopt;
    node = &node->at(key);
    begin = end + 1;
  }
  if (node->is_array()) return static_cast<double>(node->size());
  return node->is_number() ? std::optional(node->get<double>()) : std::nullopt;
}

}  // namespace

std::string Metrics::json() const {
  Json json = to_json(*this);
  Json& results = json["expectations"] = Json::object();
  for (const ExpectationResult& e : expectations)
    results[e.metric] = {{"value", number(e.value)}, {"bound", e.bound.text()}, {"pass", e.pass}};
  return json.dump(2) + "\n";
}

std::optional<double> Metrics::value(const std::string& metric) const {
  return find(to_json(*this), metric);
}

void Metrics::compare(const MetricBounds& bounds) {
  expectations.clear();
  for (const auto& [metric, bound] : bounds) {
    const std::optional<double> found = value(metric);
    expectations.push_back({metric, found, bound, found && bound.holds(*found)});
  }
}

}  // namespace vsslam

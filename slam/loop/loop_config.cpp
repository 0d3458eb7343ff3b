#include "slam/loop/loop_config.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <utility>

#include "core/errors.h"
#include "core/suggestion.h"

namespace vsslam {

namespace {
constexpr std::array<std::pair<Method, std::string_view>, 6> kNames{{
    {Method::lvi_sam_no_loop, "lvi-sam-no-loop"},
    {Method::lvi_sam, "lvi-sam"},
    {Method::sc_lvi_sam, "sc-lvi-sam"},
    {Method::vs_slam_no_vd, "vs-slam-no-vd"},
    {Method::vs_slam_no_st, "vs-slam-no-st"},
    {Method::vs_slam, "vs-slam"},
}};
}  // namespace

std::string_view method_name(Method method) {
  for (const auto& [m, name] : kNames)
    if (m == method) return name;
  return "?";
}

Method parse_method(std::string_view name) {
  std::vector<std::string> names;
  for (const auto& [method, known] : kNames) {
    if (known == name) return method;
    names.emplace_back(known);
  }
  throw InputError(fmt::format("unknown method \"{}\" ({})", name, suggestion(name, names)));
}

const std::vector<Method>& all_methods() {
  static const std::vector<Method> methods = [] {
    std::vector<Method> list;
    for (const auto& entry : kNames) list.push_back(entry.first);
    return list;
  }();
  return methods;
}

void ScanContextConfig::fields(Fields& f) {
  f("max_range_m", max_range_m, positive());
}

void LocalMapConfig::fields(Fields& f) {
  f("half_width_scans", half_width_scans, between(0, 1000));
  f("voxel_m", voxel_m, between(0.01, 10));
}

void IcpConfig::fields(Fields& f) {
  f("max_correspondence_m", max_correspondence_m, positive());
  f("max_iterations", max_iterations, between(1, 10000));
  f("coarse_stride", coarse_stride, between(1, 1000));
  f("step_translation_m", step_translation_m, non_negative());
  f("step_rotation_rad", step_rotation_rad, between(0, 1));
  f("relative_mse_change", relative_mse_change, between(0, 1));
}

double VerificationConfig::allowed_gap_m(double way_m) const {
  if (max_gap_m <= 0 && max_gap_share <= 0) return std::numeric_limits<double>::infinity();
  return max_gap_m + max_gap_share * way_m;
}

void VerificationConfig::fields(Fields& f) {
  f("icp", icp);
  f("max_fitness_m2", max_fitness_m2, positive());
  f("overlap_distance_m", overlap_distance_m, positive());
  f("min_overlap", min_overlap, between(0, 1));
  f("min_source_points", min_source_points, at_least(3));
  f("min_target_points", min_target_points, at_least(3));
  f("centroid_guess_m", centroid_guess_m, non_negative());
  f("prediction_ratio", prediction_ratio, between(0, 10));
  f("min_plane_share", min_plane_share, between(0, 1));
  f("max_gap_m", max_gap_m, non_negative());
  f("max_gap_share", max_gap_share, between(0, 1));
  f("max_gap_rad", max_gap_rad, between(0, 4));
}

void LviSamLoopConfig::fields(Fields& f) {
  f("period_s", period_s, non_negative());
  f("search_radius_m", search_radius_m, positive());
  f("min_age_s", min_age_s, non_negative());
  f("verification", verification);
}

void ScLviSamLoopConfig::fields(Fields& f) {
  f("period_s", period_s, non_negative());
  f("max_distance", max_distance, between(0, 2));
  f("exclude_recent_scans", exclude_recent_scans, at_least(1));
  f.choice("verification", verification,
           {{"as_published", Verification::as_published}, {"repaired", Verification::repaired}});
  f("as_published", as_published);
  f("repaired", repaired);
  f("edge_variance", edge_variance, positive());
  f("cauchy_scale", cauchy_scale, non_negative());
}

void VirtualDescriptorConfig::fields(Fields& f) {
  f("distances", distances, between(0, 16));
  f("spacing_m", spacing_m, positive());
}

void SelectiveMemoryConfig::fields(Fields& f) {
  f("scene_recognition", scene_recognition);
  f("key_descriptors", key_descriptors);
  f("alpha_t_th", alpha_t_th, between(0, 1));
  f("alpha_r_th", alpha_r_th, between(0, 1));
  f.choice("novel_to", novel_to, {{"last", NovelTo::last}, {"search", NovelTo::search}});
  f("key_distance", key_distance, between(0, 2));
}

VsSlamLoopConfig VsSlamLoopConfig::variant(Method method) const {
  VsSlamLoopConfig config = *this;
  if (method == Method::vs_slam_no_vd) config.virtual_descriptors.distances = 0;
  if (method == Method::vs_slam_no_st) {
    config.memory.scene_recognition = false;
    config.memory.key_descriptors = false;
  }
  return config;
}

void VsSlamLoopConfig::fields(Fields& f) {
  f("period_s", period_s, non_negative());
  f("max_distance", max_distance, between(0, 2));
  f("exclude_recent_s", exclude_recent_s, non_negative());
  f("exclude_recent_scans", exclude_recent_scans, at_least(1));
  f("search_reach_m", search_reach_m, non_negative());
  f("virtual_descriptors", virtual_descriptors);
  f("memory", memory);
  f("verification", verification);
  f("edge_variance", edge_variance, positive());
  f("cauchy_scale", cauchy_scale, non_negative());
}

void LoopConfig::fields(Fields& f) {
  f("scan_context", scan_context);
  f("local_map", local_map);
  f("exhaustive_pairs", exhaustive_pairs, at_least(0));
  f("lvi_sam", lvi_sam);
  f("sc_lvi_sam", sc_lvi_sam);
  f("vs_slam", vs_slam);
}

}  // namespace vsslam

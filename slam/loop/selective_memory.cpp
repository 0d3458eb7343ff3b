#include "slam/loop/selective_memory.h"

#include <algorithm>

namespace vsslam {

namespace {

// s: similar (0) if either ellipsoid of the information is oblate beyond its threshold.
bool distinct(const SelectiveMemoryConfig& config, const Information& information) {
  return !config.scene_recognition || (information.translation.alpha() < config.alpha_t_th &&
                                       information.rotation.alpha() < config.alpha_r_th);
}

// m (6): all descriptors of the query differ from what is stored.
bool novel(const SelectiveMemoryConfig& config, std::span<const QueryDescriptor> query,
           const std::vector<const ScanContext*>& stored) {
  const auto differs = [&](const ScanContext& context) {
    return std::all_of(query.begin(), query.end(), [&](const QueryDescriptor& descriptor) {
      return scan_context_distance(descriptor.context, context).distance > config.key_distance;
    });
  };
  return !config.key_descriptors ||
         std::all_of(stored.begin(), stored.end(),
                     [&](const ScanContext* context) { return differs(*context); });
}

}  // namespace

MemoryDecision decide(const SelectiveMemoryConfig& config, const Information& information,
                      std::span<const QueryDescriptor> query, const std::vector<const ScanContext*>& stored) {
  return {distinct(config, information), novel(config, query, stored)};
}

}  // namespace vsslam

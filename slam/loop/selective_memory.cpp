#include "slam/loop/selective_memory.h"

#include <algorithm>

namespace vsslam {

MemoryDecision SelectiveMemory::decide(const Information& information,
                                       std::span<const QueryDescriptor> query) {
  const MemoryDecision decision{distinct(information), novel(query)};
  if (decision.stored()) last_stored_ = query.front().context;
  return decision;
}

// s: similar (0) if either ellipsoid of the information is oblate beyond its threshold.
bool SelectiveMemory::distinct(const Information& information) const {
  return !config_.scene_recognition || (information.translation.alpha() < config_.alpha_t_th &&
                                        information.rotation.alpha() < config_.alpha_r_th);
}

// m (6): all descriptors of the query differ from the last stored one.
bool SelectiveMemory::novel(std::span<const QueryDescriptor> query) const {
  if (!config_.key_descriptors || !last_stored_) return true;
  return std::all_of(query.begin(), query.end(), [&](const QueryDescriptor& descriptor) {
    return scan_context_distance(descriptor.context, *last_stored_).distance > config_.key_distance;
  });
}

}  // namespace vsslam

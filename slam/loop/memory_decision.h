// What selective memory decides about a key scan (Song et al. 2025, section 4.2).
#pragma once

namespace vsslam {

struct MemoryDecision {
  /// s = 1: the scene is not structurally similar along some direction; else it is not searched for.
  bool distinct = true;
  bool novel = true;                                 ///< m = 1: unlike what is stored (6)
  bool stored() const { return distinct && novel; }  ///< tau = s m (7)
};

}  // namespace vsslam

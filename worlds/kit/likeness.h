// Draws for features that come in families: how alike the members are is a parameter, and raising it changes
// members one by one instead of drawing everything anew.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/rng.h"

namespace vsslam {

class Likeness {
 public:
  /// alike = 0: every member draws for itself; 1: all draw what the first one drew.
  Likeness(uint64_t seed, double alike) : seed_(seed), alike_(alike) {}

  /// For choices. A share `alike` of the members of each family copies the first.
  double choice(std::string_view family, uint64_t member, uint64_t item = 0) const {
    const RandomStream coin(seed_ ^ 0x5DEECE66Dull, family);
    const bool copies = coin.uniform(member, item) < alike_;
    return RandomStream(seed_, family).uniform(copies ? 0 : member, item);
  }
  /// For sizes: between the member's own draw and the first one's.
  double blend(std::string_view family, uint64_t member, uint64_t item = 0) const {
    const RandomStream own(seed_, family);
    return (1 - alike_) * own.uniform(member, item) + alike_ * own.uniform(0, item);
  }

 private:
  uint64_t seed_;
  double alike_;
};

}  // namespace vsslam

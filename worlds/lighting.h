// How the world is lit: which of its lights shine, and how strongly.
#pragma once

#include "core/config.h"

namespace vsslam {

/// LiDAR scans do not depend on it; images do.
struct LightingConfig {
  enum class Preset { even, non_uniform, low, dark, bright };
  Preset preset = Preset::even;
  void fields(Fields& f);
};

}  // namespace vsslam

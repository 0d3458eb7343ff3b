// Light that reaches surfaces straight from its source.
#pragma once

#include "sensors/light/light_map.h"

namespace vsslam {

/// Adds to `illuminance` (sites x groups) what the sources throw on sites [begin, end).
void add_direct_light(const LitScene& scene, size_t begin, size_t end, std::vector<float>& illuminance);

}  // namespace vsslam

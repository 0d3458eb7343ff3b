// Light that reaches surfaces from other surfaces and from the sky.
#pragma once

#include "sensors/light/light_map.h"

namespace vsslam {

struct IndirectLight {
  std::vector<float> illuminance;  ///< sites x groups, without the direct light
  size_t rays = 0;                 ///< that each site has sent out
  std::vector<bool> buried;        ///< sites that mostly see back faces: within or under something
};
IndirectLight bounce_light(const LitScene& scene, const std::vector<float>& direct);

}  // namespace vsslam

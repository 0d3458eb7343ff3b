// What a world holds, for people.
#pragma once

#include <string>

#include "worlds/world.h"

namespace vsslam {

struct Bounds {
  Vec3 low_world = Vec3::Zero(), high_world = Vec3::Zero();
};
/// Of all objects; zero if there are none.
Bounds bounds(const World& world);

/// Size, counts, materials with what the LiDAR gets from them, routes and lights: several lines of text.
std::string describe(const World& world);

}  // namespace vsslam

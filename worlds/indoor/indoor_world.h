// Puts the shell of an indoor world into it.
#pragma once

#include "worlds/kit/floor_plan.h"
#include "worlds/world.h"

namespace vsslam {

/// Objects "floor" (no collision: wheels stand on World::floor), "walls" and "ceiling".
void add_shell(World& world, Shell shell);

}  // namespace vsslam

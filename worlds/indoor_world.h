// Puts the parts of an indoor world together.
#pragma once

#include "worlds/floor_plan.h"
#include "worlds/indoor_palette.h"

namespace vsslam {

/// Objects "floor" (no collision: wheels stand on World::floor), "walls" and "ceiling".
void add_shell(World& world, Shell shell);

/// Takes over materials and textures, and drops those that nothing uses.
void adopt_palette(World& world, IndoorPalette palette);

}  // namespace vsslam

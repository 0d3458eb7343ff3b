// Materials of the indoor worlds: what the camera sees (seeded procedural textures) and what the LiDAR gets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "worlds/kit/floor_plan.h"
#include "worlds/kit/palette.h"
#include "worlds/world.h"

namespace vsslam {

/// Materials by their use. Indices are into `materials`.
struct IndoorPalette : Palette {
  std::vector<Finish> corridor_walls;  ///< variants of one paint: they may stand side by side
  std::vector<Finish> room_walls;      ///< paints that tell one lobby or corner from another
  std::vector<Finish> room_floors;
  Finish corridor_floor, ceiling, pillar;

  std::vector<int> doors, posters;
  int door_frame = 0, glass = 0;
  int extinguisher_sign = 0, exit_sign = 0;  ///< retro-reflective
  int lamp = 0, emergency_lamp = 0;          ///< named like the light groups that switch them
  int wood = 0, metal = 0, cardboard = 0, foliage = 0, pot = 0, fabric = 0;
};

/// `wall_height_m` is what one repetition of a wall's texture covers, floor to ceiling. Without textures the
/// materials are plain: enough for the LiDAR, and cheaper.
IndoorPalette make_indoor_palette(uint64_t seed, double wall_height_m, bool textures);

/// The light of a luminous ceiling panel of the palette's material `group` ("lamp", "emergency"), just below it.
Light ceiling_lamp(const std::string& group, size_t number, const Vec3& panel_world, double area_m2);

}  // namespace vsslam

// Houses: facades with recessed windows and doors, plinths, ledges, pilasters, balconies, flat roofs.
#pragma once

#include <array>
#include <cstdint>

#include "worlds/kit/mesh_builder.h"
#include "worlds/kit/outdoor_palette.h"

namespace vsslam {

struct Building {
  Rect footprint;
  double base_m = 0;  ///< height of the ground it stands on
  int floors = 3;
  Facing front = Facing::south;                         ///< has the door
  std::array<bool, 4> visible{true, true, true, true};  ///< walls, by Facing; the others are plain
  uint64_t look = 1;        ///< everything else is drawn from it: equal looks are equal houses
  double lit_share = 0.15;  ///< of the windows
};

/// All wall openings are cut along one lattice per wall, so its surface has no cracks.
void add_building(MeshBuilder& builder, const OutdoorPalette& palette, const Building& building);

/// Of the roof above the ground.
double building_height_m(const Building& building);

}  // namespace vsslam

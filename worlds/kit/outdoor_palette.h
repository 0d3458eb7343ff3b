// Materials of the outdoor worlds: what the camera sees (seeded procedural textures) and what the LiDAR gets.
#pragma once

#include <cstdint>
#include <vector>

#include "worlds/kit/floor_plan.h"
#include "worlds/kit/palette.h"

namespace vsslam {

/// Materials by their use. Indices are into `materials`.
struct OutdoorPalette : Palette {
  Finish asphalt, paving, pavement, lawn, kerb;
  std::vector<Finish> facades;      ///< plaster, brick and concrete in several colours
  Finish stone, roof;               ///< ledges, plinths, steps; flat roofs
  std::vector<int> windows, doors;  ///< their textures cover 0..1; window glass mirrors the LiDAR away
  int lit_window = 0;               ///< somebody is at home
  std::vector<int> foliage, posters;
  std::vector<int> car_paints, clothes;
  int bark = 0, hedge = 0, wood = 0, skin = 0, hair = 0;
  int steel = 0, dark_steel = 0, rubber = 0, car_glass = 0, tail_light = 0;
  int sign = 0, number_plate = 0;  ///< retro-reflective
  int marking = 0;                 ///< on asphalt
  int lamp = 0;                    ///< named like the light group that switches it
};

/// Without textures the materials are plain: enough for the LiDAR, and cheaper.
OutdoorPalette make_outdoor_palette(uint64_t seed, bool textures);

/// The light of a street lamp whose luminous disc (material `lamp`) faces down at `head_world`.
Light street_light(size_t number, const Vec3& head_world, double area_m2);

/// Daylight: the sun, seen through thin clouds.
Light sunlight();

}  // namespace vsslam

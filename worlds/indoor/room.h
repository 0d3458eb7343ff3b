// A furnished room for quick tests: door recess, pillars, cupboards, a table, boxes. South-west corner of its
// floor at (-length/2, -width/2). Route "loop": closed, counter-clockwise rounded rectangle about the
// origin, from the middle of its southern side.
#pragma once

#include <cstdint>

#include "core/config.h"
#include "worlds/world.h"

namespace vsslam {

struct RoomConfig {
  double length_m = 12.0;  ///< along x
  double width_m = 10.0;   ///< along y
  double height_m = 3.0;
  double clutter = 1.0;             ///< 0..1: share of the furniture
  double floor_unevenness_m = 0.0;  ///< RMS
  double floor_wavelength_m = 2.0;
  double tessellation_m = 0.75;
  bool textures = true;
  uint64_t seed = 1;

  void fields(Fields& f);
};

World make_room(const RoomConfig& config);

}  // namespace vsslam

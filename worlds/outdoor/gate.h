// Campus gate worlds: a paved square with a lawn in its middle and university houses on three sides; on the
// fourth a fence with the gate, and behind it a street with houses opposite.
//
// The square lies about the origin, size_m wide; the gate is in the middle of its southern side, the street runs
// along x south of it. What can be driven on is at height 0. Routes are closed and start south of the lawn:
//   around     counter-clockwise round the lawn
//   out_west   round the lawn, out through the gate, a stretch along the street to the west, and back in
//   out_east   round the lawn in the wider circle the other way, out, to the east, and back in
#pragma once

#include <cstdint>

#include "core/config.h"
#include "worlds/world.h"

namespace vsslam {

struct GateConfig {
  double size_m = 84;
  int fewest_floors = 3, most_floors = 6;
  double aliasing = 0;      ///< how alike the houses of each row are
  int trees = 34;           ///< on the square; those that find a place
  int leaf_clusters = 900;  ///< of a tree, on average
  double lamp_spacing_m = 20;
  double parked_share = 0.6;  ///< of the places for cars
  int people = 26;
  double lit_share = 0.2;  ///< of windows
  bool textures = true;    ///< false: plain colours, for LiDAR-only use
  uint64_t seed = 1;

  void fields(Fields& f);
};

World make_gate(const GateConfig& config);

}  // namespace vsslam

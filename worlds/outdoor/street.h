// Street worlds: a grid of blocks with houses on both sides of every street, kerbs and pavements, parked cars,
// lamps, trees and people, and in its middle a lawn that is two blocks long.
//
// Crossing (i, j) lies at ((i - columns / 2) pitch_x_m, (j - rows / 2) pitch_y_m). The lawn takes the blocks
// between crossings (1, 1) and (3, 2). Carriageways are at height 0, what people walk on 0.12 m above.
// Routes run on the middle of the carriageways:
//   avenue   open, along the southernmost street from west to east
//   lawn     closed: from the middle of the lawn's southern side once around it counter-clockwise, then out to
//            the south, around the eastern and northern blocks and back
//   zigzag   open: from crossing (0, rows) through the north-western blocks to (2, 2), back along the lawn and
//            over the first streets again
#pragma once

#include <cstdint>

#include "core/config.h"
#include "worlds/world.h"

namespace vsslam {

struct StreetConfig {
  int columns = 4, rows = 3;              ///< blocks
  double pitch_x_m = 80, pitch_y_m = 60;  ///< from street to street
  double road_width_m = 10.4;             ///< from kerb to kerb; cars are parked within
  double pavement_width_m = 3;
  int fewest_floors = 2, most_floors = 5;
  /// How alike the rows of houses are: at 1 all repeat each other.
  double aliasing = 0;
  double tree_spacing_m = 17;  ///< 0: no trees
  int leaf_clusters = 500;     ///< of a tree, on average
  double lamp_spacing_m = 26;
  double parked_share = 0.55;  ///< of the places for cars
  int people = 60;
  double lit_share = 0.15;  ///< of windows
  bool textures = true;     ///< false: plain colours, for LiDAR-only use
  uint64_t seed = 1;

  void fields(Fields& f);
};

World make_street(const StreetConfig& config);

}  // namespace vsslam

// Houses side by side along a strip of land, with gaps between some of them.
#pragma once

#include <vector>

#include "worlds/kit/likeness.h"
#include "worlds/outdoor/building.h"

namespace vsslam {

struct HouseRow {
  Rect strip;
  Facing front = Facing::south;  ///< the row runs along this side of the strip
  uint64_t member = 0;           ///< number of the row among those that may be alike
  double base_m = 0;
  double lot_m = 20;  ///< width of a house, on average
  int fewest_floors = 2, most_floors = 5;
  double gap_share = 0.25;  ///< of houses with an open space beside them
  bool visible_back = true;
  double lit_share = 0.15;
};

struct HouseRowPlan {
  std::vector<Building> houses;
  std::vector<Rect> gaps;  ///< as deep as the strip
};
HouseRowPlan plan_row(const HouseRow& row, const Likeness& like);

}  // namespace vsslam

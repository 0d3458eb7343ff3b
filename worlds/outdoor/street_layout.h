// Where the carriageways and blocks of a street world lie.
#pragma once

#include <vector>

#include "worlds/kit/floor_plan.h"
#include "worlds/outdoor/street.h"

namespace vsslam {

struct Block {
  enum class Kind { houses, lawn, edge, corner } kind = Kind::houses;
  Rect rect;                     ///< from kerb to kerb
  Facing front = Facing::south;  ///< edge: where its street is
};

/// A stretch of one side of a street between two crossings, seen by who walks along it with the carriageway on the
/// left.
struct Roadside {
  Vec3 begin_world, end_world;  ///< on the kerb
  Vec3 to_road;                 ///< unit
};

struct StreetLayout {
  std::vector<Rect> roads;
  std::vector<Block> blocks;
  std::vector<Roadside> roadsides;
  std::vector<Route> routes;
};

Vec3 crossing(const StreetConfig& config, int column, int row);
StreetLayout lay_out(const StreetConfig& config);

inline constexpr double kPavementHeight_m = 0.12;

}  // namespace vsslam

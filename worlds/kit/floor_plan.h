// Rooms and corridors from a plan of axis-parallel rectangles. Floor, walls and ceiling are cut along one
// common lattice, so they meet vertex to vertex: no cracks, no T-junctions, and what is painted on a wall
// (doors, posters, signs) lies exactly in the wall's plane.
#pragma once

#include <string>
#include <vector>

#include "worlds/kit/mesh_builder.h"
#include "worlds/world.h"

namespace vsslam {

struct Rect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool contains(double x, double y) const { return x > x0 && x < x1 && y > y0 && y < y1; }
  bool overlaps(const Rect& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

/// A material repeated over a surface every so many metres.
struct Finish {
  int material = 0;
  double width_m = 1, height_m = 1;  ///< that one repetition of its texture covers
};

/// Part of the plan that is free space between a floor and a ceiling. Later areas win where they overlap.
struct Area {
  Rect rect;
  double ceiling_m = 3.0;
  Finish floor, ceiling;
  std::vector<Finish> walls{};  ///< variants, one per wall.width_m along a wall, chosen by `wall_seed`
  uint64_t wall_seed = 0;
  int wall_period = 0;    ///< > 0: the choice repeats after so many sections
  int quarter_turns = 0;  ///< heading of the area: the choice turns with it
};

/// The direction in which a wall's normal points.
enum class Facing { east, north, west, south };

/// Something painted on a wall: a rectangle of the wall's plane with a material of its own.
struct WallPanel {
  Facing facing = Facing::north;
  double at_m = 0;              ///< the plane: x (east, west) or y (north, south)
  double from_m = 0, to_m = 0;  ///< along the wall: y (east, west) or x (north, south)
  double bottom_m = 0, top_m = 0;
  int material = 0;
};

/// The same on the ceiling.
struct CeilingPanel {
  Rect rect;
  int material = 0;
};

struct FloorPlan {
  std::vector<Area> areas{};
  std::vector<Rect> solids{};  ///< square pillars and blocks from floor to ceiling
  Finish solid_finish;
  std::vector<WallPanel> wall_panels{};  ///< later ones win
  std::vector<CeilingPanel> ceiling_panels{};
  double tessellation_m = 0.75;  ///< no edge of floor, walls and ceiling is longer

  bool inside(double x, double y) const;
  /// True where an unbroken wall of the plan carries this panel.
  bool carries(const WallPanel& panel) const;
};

struct Shell {
  Mesh floor, walls, ceiling;
};
/// The floor follows `floor`; walls reach down to it.
Shell build_shell(const FloorPlan& plan, const Floor& floor);

}  // namespace vsslam

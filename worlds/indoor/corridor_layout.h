// Where the corridors, lobbies and corner rooms of a corridor world lie.
#pragma once

#include <vector>

#include "worlds/indoor/corridor.h"
#include "worlds/kit/floor_plan.h"
#include "worlds/kit/indoor_palette.h"

namespace vsslam {

/// One straight corridor: s runs along its centre line from one corner to the next, t to the left. In a ring
/// driven counter-clockwise, left is the inside.
struct Leg {
  Eigen::Vector2d start_world = Eigen::Vector2d::Zero();
  int quarter_turns = 0;  ///< heading: 0 along x, 1 along y, ...
  double length_m = 0, width_m = 0;
  int index = 0;

  Eigen::Vector2d to_world(double s_m, double t_m) const;
  Rect rect(double s0_m, double t0_m, double s1_m, double t1_m) const;
  double heading_rad() const;
  /// A panel on the right (t < 0) or left wall that stands `t_m` from the centre line.
  WallPanel panel(double t_m, double from_s_m, double to_s_m, double bottom_m, double top_m,
                  int material) const;
  /// The same on a wall across the corridor at s_m that faces back along it.
  WallPanel end_panel(double s_m, double from_t_m, double to_t_m, double bottom_m, double top_m,
                      int material) const;
};

/// A lobby or a corner room: `rect` in the world, seen from a leg.
struct Place {
  enum class Kind { lobby, corner } kind = Kind::lobby;
  int index = 0;  ///< among places of its kind
  Leg leg;
  double s0_m = 0, t0_m = 0, s1_m = 0, t1_m = 0;  ///< extent in the leg's coordinates
  double ceiling_m = 0;
  Rect rect() const { return leg.rect(s0_m, t0_m, s1_m, t1_m); }
};

struct CorridorLayout {
  std::vector<Leg> legs;
  std::vector<Place> places;
  std::vector<Route> routes;
};

CorridorLayout lay_out(const CorridorConfig& config);

/// Corridors first, then lobbies, corner rooms and alcoves.
std::vector<Area> areas_of(const CorridorLayout& layout, const CorridorConfig& config,
                           const IndoorPalette& palette);

/// To 5 cm, so that lines of the lattice coincide or keep a distance.
double snap_m(double value_m);

}  // namespace vsslam

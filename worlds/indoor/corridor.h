// Corridor worlds: a closed rectangular ring of corridors with lobbies and corner rooms, or one straight
// dead-end corridor. Long walls carry paint that a camera sees and, with jamb_depth_m = 0, no geometry at
// all for the LiDAR.
//
// The ring's centre line is a rectangle about the origin, length_m along x and breadth_m along y. Its sides
// ("legs") are numbered counter-clockwise from the southern one. The straight corridor lies along x about
// the origin. Routes run on the centre line:
//   ring            closed, counter-clockwise from the middle of the southern side (in its lobby)
//   ring_clockwise  the same from the same point, the other way
//   straight        open, west to east, from 2 m behind one end wall to 2 m before the other
#pragma once

#include <cstdint>

#include "core/config.h"
#include "worlds/world.h"

namespace vsslam {

struct CorridorConfig {
  enum class Layout { ring, straight };
  Layout layout = Layout::ring;
  double length_m = 75.0;   ///< centre line of the long sides; of the straight corridor wall to wall
  double breadth_m = 18.0;  ///< centre line of the short sides
  double width_m = 2.4;
  double height_m = 3.0;

  double door_spacing_m = 4.0;  ///< along every wall; 0: no doors
  double jamb_depth_m = 0.0;    ///< how far doors stand back in the wall; 0: flush, invisible to the LiDAR
  double glass_share = 0.25;    ///< of doors with a glass pane
  int alcoves = 0;              ///< per long wall
  double alcove_width_m = 2.0;
  double alcove_depth_m = 0.8;

  int lobbies = 1;  ///< per long side (ring); one on each side lies in its middle if odd
  double lobby_length_m = 7.0;
  double lobby_width_m = 5.6;
  double corner_extra_m = 1.2;  ///< by how much corner rooms reach beyond the corridors' crossing, at most

  /// How alike the two long sides are (and the two short ones): at 1 paint, doors and alcoves of one are
  /// the other's turned by half a turn.
  double symmetry = 0.9;
  /// How alike places within the world are: at 1 all lobbies, all corner rooms and all sections of a wall
  /// repeat each other.
  double aliasing = 0.2;
  double clutter = 0.6;       ///< 0..1: furniture and pillars in lobbies and corner rooms
  double wall_clutter = 0.0;  ///< 0..1: boxes, bins and plants along the corridor's walls

  double lamp_spacing_m = 4.0;
  double floor_unevenness_m = 0.0;  ///< RMS
  double floor_wavelength_m = 2.0;
  double tessellation_m = 1.0;  ///< longest edge of floor, walls and ceiling
  bool textures = true;         ///< false: plain colours, for LiDAR-only use
  uint64_t seed = 1;

  void fields(Fields& f);
};

World make_corridor(const CorridorConfig& config);

}  // namespace vsslam

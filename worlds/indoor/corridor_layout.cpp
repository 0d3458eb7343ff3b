#include "worlds/indoor/corridor_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "worlds/kit/likeness.h"
#include "worlds/route.h"

namespace vsslam {

namespace {

constexpr double kArcRadius_m = 1.2;
constexpr double kRouteSpacing_m = 1.0;

Facing turned(Facing facing, int quarter_turns) {
  return static_cast<Facing>((static_cast<int>(facing) + quarter_turns) % 4);
}

std::vector<Leg> ring_legs(const CorridorConfig& c) {
  const double x = c.length_m / 2, y = c.breadth_m / 2;
  return {
      {.start_world = {-x, -y}, .quarter_turns = 0, .length_m = c.length_m, .width_m = c.width_m, .index = 0},
      {.start_world = {x, -y}, .quarter_turns = 1, .length_m = c.breadth_m, .width_m = c.width_m, .index = 1},
      {.start_world = {x, y}, .quarter_turns = 2, .length_m = c.length_m, .width_m = c.width_m, .index = 2},
      {.start_world = {-x, y},
       .quarter_turns = 3,
       .length_m = c.breadth_m,
       .width_m = c.width_m,
       .index = 3}};
}

// The crossing of the leg before (which arrives from +t) with this one, enlarged on each side by its own
// draw.
Place corner_room(const CorridorConfig& c, const Leg& leg) {
  const Likeness like(c.seed, c.aliasing);
  const double half_m = c.width_m / 2;
  const auto extra = [&](uint64_t side) {
    return snap_m(c.corner_extra_m * like.blend("corner size", static_cast<uint64_t>(leg.index), side));
  };
  const bool high = like.choice("corner ceiling", static_cast<uint64_t>(leg.index)) < 0.4;
  return {.kind = Place::Kind::corner,
          .index = leg.index,
          .leg = leg,
          .s0_m = -half_m - extra(0),
          .t0_m = -half_m - extra(1),
          .s1_m = half_m + extra(2),
          .t1_m = half_m + extra(3),
          .ceiling_m = c.height_m + (high ? 0.4 : 0.0)};
}

Place lobby(const CorridorConfig& c, const Leg& leg, int k) {
  const Likeness like(c.seed, c.aliasing);
  const int index = leg.index / 2 * c.lobbies + k;
  const auto draw = [&](uint64_t item) {
    return like.blend("lobby size", static_cast<uint64_t>(index), item);
  };
  const double middle_m = snap_m(leg.length_m * (k + 0.5) / c.lobbies);
  const double half_length_m = snap_m(c.lobby_length_m / 2 * (0.75 + 0.5 * draw(0)));
  const double depth_m = std::max(c.lobby_width_m - c.width_m, 0.0) * (0.75 + 0.5 * draw(1));
  const double left_share = 0.2 + 0.6 * draw(2);
  return {.kind = Place::Kind::lobby,
          .index = index,
          .leg = leg,
          .s0_m = middle_m - half_length_m,
          .t0_m = -c.width_m / 2 - snap_m(depth_m * (1 - left_share)),
          .s1_m = middle_m + half_length_m,
          .t1_m = c.width_m / 2 + snap_m(depth_m * left_share),
          .ceiling_m = c.height_m + 0.6};
}

std::vector<Route> ring_routes(const CorridorConfig& c) {
  const double x = c.length_m / 2, y = c.breadth_m / 2;
  const Route ring =
      rounded_loop("ring", {{x, -y, 0}, {x, y, 0}, {-x, y, 0}, {-x, -y, 0}}, kArcRadius_m, kRouteSpacing_m);
  return {ring, reversed(ring, "ring_clockwise")};
}

CorridorLayout straight_layout(const CorridorConfig& c) {
  const double x = c.length_m / 2;
  const Leg leg{
      .start_world = {-x, 0}, .quarter_turns = 0, .length_m = c.length_m, .width_m = c.width_m, .index = 0};
  const double margin_m = std::min(2.0, c.length_m / 4);
  return {
      {leg}, {}, {straight_route("straight", {-x + margin_m, 0, 0}, {x - margin_m, 0, 0}, kRouteSpacing_m)}};
}

Area corridor_area(const Leg& leg, const CorridorConfig& c, const IndoorPalette& palette) {
  // A leg that resembles the one half a turn away wears the same paint in the same order.
  const auto family = static_cast<uint64_t>(leg.index % 2);
  const auto paint =
      static_cast<uint64_t>(Likeness(c.seed, c.symmetry).choice("leg paint", leg.index / 2, family) * 1e9);
  return {.rect = leg.rect(0, -leg.width_m / 2, leg.length_m, leg.width_m / 2),
          .ceiling_m = c.height_m,
          .floor = palette.corridor_floor,
          .ceiling = palette.ceiling,
          .walls = palette.corridor_walls,
          .wall_seed = paint + family,
          .wall_period = c.aliasing >= 1 ? 1 : 0,
          .quarter_turns = leg.quarter_turns};
}

Area place_area(const Place& place, const CorridorConfig& c, const IndoorPalette& palette) {
  const Likeness like(c.seed, c.aliasing);
  const auto pick = [&](const char* what, size_t size) {
    const uint64_t family = place.kind == Place::Kind::corner ? 1 : 0;
    return static_cast<size_t>(like.choice(what, static_cast<uint64_t>(place.index), family) *
                               static_cast<double>(size));
  };
  Finish wall = palette.room_walls[pick("place paint", palette.room_walls.size())];
  wall.height_m = place.ceiling_m;
  return {.rect = place.rect(),
          .ceiling_m = place.ceiling_m,
          .floor = palette.room_floors[pick("place floor", palette.room_floors.size())],
          .ceiling = palette.ceiling,
          .walls = {wall}};
}

// Niches across the whole height, evenly spread with a jitter, on both walls.
void add_alcoves(std::vector<Area>& areas, const Leg& leg, const CorridorConfig& c,
                 const IndoorPalette& palette) {
  const Likeness like(c.seed, c.symmetry);
  for (int k = 0; k < c.alcoves; ++k)
    for (const double side : {-1.0, 1.0}) {
      const auto item = static_cast<uint64_t>(2 * k + (side > 0) + 1000 * (leg.index % 2));
      const double jitter = like.choice("alcove", static_cast<uint64_t>(leg.index / 2), item) - 0.5;
      const double s_m = snap_m(leg.length_m * (k + 0.5 + 0.6 * jitter) / c.alcoves);
      const double half_m = c.alcove_width_m / 2, near_m = side * leg.width_m / 2;
      Area niche = corridor_area(leg, c, palette);
      niche.rect = leg.rect(s_m - half_m, near_m, s_m + half_m, near_m + side * c.alcove_depth_m);
      areas.push_back(niche);
    }
}

}  // namespace

Eigen::Vector2d Leg::to_world(double s, double t) const {
  switch (quarter_turns % 4) {
    case 0:
      return start_world + Eigen::Vector2d(s, t);
    case 1:
      return start_world + Eigen::Vector2d(-t, s);
    case 2:
      return start_world + Eigen::Vector2d(-s, -t);
    default:
      return start_world + Eigen::Vector2d(t, -s);
  }
}

Rect Leg::rect(double s0, double t0, double s1, double t1) const {
  const Eigen::Vector2d a = to_world(s0, t0), b = to_world(s1, t1);
  return {std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()), std::max(a.y(), b.y())};
}

double Leg::heading_rad() const {
  return quarter_turns * std::numbers::pi / 2;
}

WallPanel Leg::panel(double t, double from_s, double to_s, double bottom_m, double top_m,
                     int material) const {
  const Rect r = rect(from_s, t, to_s, t);
  const bool along_x = quarter_turns % 2 == 0;
  return {.facing = turned(t < 0 ? Facing::north : Facing::south, quarter_turns),
          .at_m = along_x ? r.y0 : r.x0,
          .from_m = along_x ? r.x0 : r.y0,
          .to_m = along_x ? r.x1 : r.y1,
          .bottom_m = bottom_m,
          .top_m = top_m,
          .material = material};
}

WallPanel Leg::end_panel(double s, double from_t, double to_t, double bottom_m, double top_m,
                         int material) const {
  const Rect r = rect(s, from_t, s, to_t);
  const bool along_x = quarter_turns % 2 == 0;
  return {.facing = turned(Facing::west, quarter_turns),
          .at_m = along_x ? r.x0 : r.y0,
          .from_m = along_x ? r.y0 : r.x0,
          .to_m = along_x ? r.y1 : r.x1,
          .bottom_m = bottom_m,
          .top_m = top_m,
          .material = material};
}

double snap_m(double value_m) {
  return std::round(value_m * 20) / 20;
}

CorridorLayout lay_out(const CorridorConfig& c) {
  if (c.layout == CorridorConfig::Layout::straight) return straight_layout(c);
  CorridorLayout layout{ring_legs(c), {}, ring_routes(c)};
  for (const Leg& leg : layout.legs) {
    layout.places.push_back(corner_room(c, leg));
    for (int k = 0; k < c.lobbies && leg.index % 2 == 0; ++k) layout.places.push_back(lobby(c, leg, k));
  }
  return layout;
}

std::vector<Area> areas_of(const CorridorLayout& layout, const CorridorConfig& c,
                           const IndoorPalette& palette) {
  std::vector<Area> areas;
  for (const Leg& leg : layout.legs) {
    areas.push_back(corridor_area(leg, c, palette));
    if (leg.index % 2 == 0) add_alcoves(areas, leg, c, palette);
  }
  for (const Place& place : layout.places) areas.push_back(place_area(place, c, palette));
  return areas;
}

}  // namespace vsslam

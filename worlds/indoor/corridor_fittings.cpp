#include "worlds/indoor/corridor_fittings.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "worlds/kit/likeness.h"
#include "worlds/kit/route_clearance.h"

namespace vsslam {

namespace {

constexpr double kDoorWidth_m = 1.1, kDoorTop_m = 2.1;
constexpr double kPanelBottom_m = 1.1, kPanelTop_m = 1.9;  // posters and panes share the lattice's lines

/// Draws for one wall of one leg. A wall resembles the one half a turn away by `symmetry`, its sections
/// resemble each other by `aliasing`.
class WallDraws {
 public:
  WallDraws(const CorridorConfig& c, const Leg& leg, bool left)
      : sides_(c.seed, c.symmetry), sections_(c.seed, c.aliasing), leg_(leg), left_(left) {}

  double operator()(std::string what, int section) const {
    what += left_ ? " left" : " right";
    what += leg_.index % 2 == 0 ? " long" : " short";
    // First which section is imitated, then which leg: both as choices of their own families.
    const double own = sections_.choice(what, static_cast<uint64_t>(section));
    return sides_.choice(what + " leg", static_cast<uint64_t>(leg_.index / 2),
                         static_cast<uint64_t>(own * 0x1p40));
  }

 private:
  Likeness sides_, sections_;
  const Leg& leg_;
  bool left_;
};

template <class T>
const T& pick(const std::vector<T>& from, double draw) {
  return from[static_cast<size_t>(draw * static_cast<double>(from.size()))];
}

void add_door(FloorPlan& plan, const Leg& leg, double side, double s_m, const CorridorConfig& c,
              const IndoorPalette& palette, double look, double pane) {
  const double t_m = side * leg.width_m / 2, from_m = s_m - kDoorWidth_m / 2, to_m = s_m + kDoorWidth_m / 2;
  const WallPanel flush = leg.panel(t_m, from_m, to_m, 0, kDoorTop_m, pick(palette.doors, look));
  if (!plan.carries(flush)) return;
  const double back_m = t_m + side * c.jamb_depth_m;
  if (c.jamb_depth_m > 0) {
    const Finish frame{palette.door_frame, 1, 1};
    plan.areas.push_back({.rect = leg.rect(from_m, t_m, to_m, back_m),
                          .ceiling_m = kDoorTop_m,
                          .floor = palette.corridor_floor,
                          .ceiling = frame,
                          .walls = {frame}});
  }
  plan.wall_panels.push_back(leg.panel(back_m, from_m, to_m, 0, kDoorTop_m, flush.material));
  if (pane < c.glass_share)
    plan.wall_panels.push_back(
        leg.panel(back_m, s_m - 0.1, s_m + 0.15, kPanelBottom_m, kPanelTop_m, palette.glass));
}

void fit_wall(FloorPlan& plan, const Leg& leg, bool left, const CorridorConfig& c,
              const IndoorPalette& palette) {
  const WallDraws draw(c, leg, left);
  const double side = left ? 1 : -1, t_m = side * leg.width_m / 2;
  const double spacing_m = c.door_spacing_m > 0 ? c.door_spacing_m : 4.0;
  const int sections = static_cast<int>(leg.length_m / spacing_m);
  const double first_m = (leg.length_m - sections * spacing_m) / 2;
  const auto hang = [&](double s_m, double width_m, double bottom_m, double top_m, int material) {
    const WallPanel panel = leg.panel(t_m, s_m - width_m / 2, s_m + width_m / 2, bottom_m, top_m, material);
    if (plan.carries(panel)) plan.wall_panels.push_back(panel);
  };
  for (int k = 0; k < sections; ++k) {
    const double door_m = snap_m(first_m + spacing_m * (k + 0.35 + 0.1 * draw("door place", k)));
    if (c.door_spacing_m > 0)
      add_door(plan, leg, side, door_m, c, palette, draw("door look", k), draw("pane", k));
    const double beside_m = std::max(0.95, 0.3 * spacing_m);
    if (draw("poster", k) < 0.6)
      hang(snap_m(door_m + beside_m + 0.3 * draw("poster place", k)), 0.6, kPanelBottom_m, kPanelTop_m,
           pick(palette.posters, draw("poster look", k)));
    if (draw("sign", k) < 0.25) hang(door_m - 0.85, 0.2, 1.6, kPanelTop_m, palette.extinguisher_sign);
  }
}

void add_lamp(FloorPlan& plan, std::vector<Light>& lights, const Leg& leg, double s_m, double t_m,
              double ceiling_m, const IndoorPalette& palette, bool emergency) {
  const double half_s_m = emergency ? 0.15 : 0.6, half_t_m = 0.15;
  plan.ceiling_panels.push_back({leg.rect(s_m - half_s_m, t_m - half_t_m, s_m + half_s_m, t_m + half_t_m),
                                 emergency ? palette.emergency_lamp : palette.lamp});
  const Eigen::Vector2d at = leg.to_world(s_m, t_m);
  const std::string group = emergency ? "emergency" : "lamp";
  lights.push_back(
      ceiling_lamp(group, lights.size() + 1, {at.x(), at.y(), ceiling_m}, 4 * half_s_m * half_t_m));
}

/// Finds free spots for furniture: on the floor, off the routes, clear of each other.
class Floorspace {
 public:
  Floorspace(const FloorPlan& plan, const std::vector<Route>& routes) : plan_(plan), routes_(routes) {}

  bool claim(const Rect& r) {
    constexpr double kGap_m = 0.05;
    const Rect wide{r.x0 - kGap_m, r.y0 - kGap_m, r.x1 + kGap_m, r.y1 + kGap_m};
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; j <= 4; ++j)
        if (!plan_.inside(r.x0 + (r.x1 - r.x0) * i / 4, r.y0 + (r.y1 - r.y0) * j / 4)) return false;
    for (const Rect& solid : plan_.solids)
      if (solid.overlaps(wide)) return false;
    for (const Rect& taken : taken_)
      if (taken.overlaps(wide)) return false;
    if (routes_.distance_m(r) < kRouteClearance_m) return false;
    taken_.push_back(r);
    return true;
  }

 private:
  const FloorPlan& plan_;
  RouteClearance routes_;
  std::vector<Rect> taken_;
};

// One piece with its back against a wall of the leg's rectangle, if there is room for it.
bool place_at_wall(Furnisher& furnisher, Floorspace& space, const Floor& floor, const Place& place, int wall,
                   double along, FurnitureKind kind) {
  constexpr double kGap_m = 0.03;
  const Vec3 size = furniture_size_m(kind);
  const double back_m = size.x() / 2 + kGap_m;
  const double s_m = wall == 0   ? place.s0_m + back_m
                     : wall == 2 ? place.s1_m - back_m
                                 : place.s0_m + along * (place.s1_m - place.s0_m);
  const double t_m = wall == 1   ? place.t0_m + back_m
                     : wall == 3 ? place.t1_m - back_m
                                 : place.t0_m + along * (place.t1_m - place.t0_m);
  const bool across = wall % 2 == 1;
  const double ds = (across ? size.y() : size.x()) / 2, dt = (across ? size.x() : size.y()) / 2;
  if (!space.claim(place.leg.rect(s_m - ds, t_m - dt, s_m + ds, t_m + dt))) return false;
  const Eigen::Vector2d at = place.leg.to_world(s_m, t_m);
  const double foot_m = floor.height(at.x(), at.y()) - 2 * floor.unevenness_m;
  furnisher.place(kind, {at.x(), at.y(), foot_m}, place.leg.heading_rad() + wall * 1.5707963267948966);
  return true;
}

}  // namespace

void fit_walls(FloorPlan& plan, const CorridorLayout& layout, const CorridorConfig& c,
               const IndoorPalette& palette) {
  for (const Leg& leg : layout.legs)
    for (const bool left : {false, true}) fit_wall(plan, leg, left, c, palette);
  const Likeness like(c.seed, c.aliasing);
  for (const Place& place : layout.places) {
    if (place.kind != Place::Kind::corner) continue;
    // Over the end of the corridor that leads away, seen by who arrives; and facing who comes along.
    const WallPanel sign = place.leg.panel(place.t0_m, -0.3, 0.3, 2.2, 2.45, palette.exit_sign);
    if (plan.carries(sign)) plan.wall_panels.push_back(sign);
    const WallPanel poster = place.leg.panel(
        place.t0_m, -0.3, 0.3, kPanelBottom_m, kPanelTop_m,
        pick(palette.posters, like.choice("corner poster", static_cast<uint64_t>(place.index))));
    if (plan.carries(poster)) plan.wall_panels.push_back(poster);
  }
}

void fit_lamps(FloorPlan& plan, std::vector<Light>& lights, const CorridorLayout& layout,
               const CorridorConfig& c, const IndoorPalette& palette) {
  const auto in_place = [&](const Eigen::Vector2d& p) {
    return std::any_of(layout.places.begin(), layout.places.end(), [&](const Place& place) {
      const Rect r = place.rect();
      return Rect{r.x0 - 0.7, r.y0 - 0.7, r.x1 + 0.7, r.y1 + 0.7}.contains(p.x(), p.y());
    });
  };
  for (const Leg& leg : layout.legs) {
    const int count = std::max(1, static_cast<int>(leg.length_m / c.lamp_spacing_m));
    const double first_m = (leg.length_m - (count - 1) * c.lamp_spacing_m) / 2;
    for (int k = 0; k < count; ++k) {
      const double s_m = snap_m(first_m + k * c.lamp_spacing_m);
      if (!in_place(leg.to_world(s_m, 0))) add_lamp(plan, lights, leg, s_m, 0, c.height_m, palette, false);
      const double between_m = snap_m(s_m + c.lamp_spacing_m / 2);
      if (k % 4 == 1 && !in_place(leg.to_world(between_m, 0)))
        add_lamp(plan, lights, leg, between_m, 0, c.height_m, palette, true);
    }
  }
  for (const Place& place : layout.places) {
    const double s_m = snap_m((place.s0_m + place.s1_m) / 2);
    for (const double shift_m : {-1.5, 1.5}) {
      if (place.kind == Place::Kind::corner && shift_m > 0) continue;
      const double at_m = place.kind == Place::Kind::corner ? s_m : s_m + shift_m;
      add_lamp(plan, lights, place.leg, at_m, 0, place.ceiling_m, palette, false);
    }
  }
}

void fit_pillars(FloorPlan& plan, const CorridorLayout& layout, const CorridorConfig& c) {
  const Likeness like(c.seed, c.aliasing);
  constexpr double kPillar_m = 0.4, kOffWall_m = 0.25;
  for (const Place& place : layout.places) {
    const auto member = static_cast<uint64_t>(place.index);
    if (place.kind != Place::Kind::lobby) continue;
    for (const double side : {-1.0, 1.0}) {
      const auto item = static_cast<uint64_t>(side > 0);
      if (like.choice("pillar", member, item) > c.clutter) continue;
      const double room_m = (side > 0 ? place.t1_m : -place.t0_m) - c.width_m / 2;
      if (room_m < kOffWall_m + kPillar_m + 0.3) continue;
      const double t_m = side * (c.width_m / 2 + kOffWall_m),
                   reach_m = snap_m((place.s1_m - place.s0_m) *
                                    (0.15 + 0.2 * like.blend("pillar place", member, item)));
      const double middle_m = snap_m((place.s0_m + place.s1_m) / 2);
      for (const double s_m : {middle_m - reach_m, middle_m + reach_m})
        plan.solids.push_back(
            place.leg.rect(s_m - kPillar_m / 2, t_m, s_m + kPillar_m / 2, t_m + side * kPillar_m));
    }
  }
}

void furnish(World& world, const FloorPlan& plan, const CorridorLayout& layout, const CorridorConfig& c,
             const IndoorPalette& palette) {
  Furnisher furnisher(world, palette, c.height_m);
  Floorspace space(plan, world.routes);
  const Likeness like(c.seed, c.aliasing), sides(c.seed, c.symmetry);
  constexpr FurnitureKind kRoomPieces[] = {
      FurnitureKind::bench, FurnitureKind::plant, FurnitureKind::cupboard, FurnitureKind::boxes,
      FurnitureKind::bin,   FurnitureKind::table, FurnitureKind::box,      FurnitureKind::bench};
  for (const Place& place : layout.places) {
    const bool lobby = place.kind == Place::Kind::lobby;
    const auto member = static_cast<uint64_t>(place.index);
    const std::string family = lobby ? "lobby furniture" : "corner furniture";
    const int wanted = static_cast<int>(std::lround(c.clutter * (lobby ? 10 : 5)));
    for (int attempt = 0, placed = 0; attempt < 8 * wanted && placed < wanted; ++attempt) {
      const auto item = static_cast<uint64_t>(3 * attempt);
      const auto kind = kRoomPieces[static_cast<size_t>(8 * like.choice(family, member, item))];
      const int wall = static_cast<int>(4 * like.choice(family, member, item + 1));
      placed += place_at_wall(furnisher, space, world.floor, place, wall,
                              like.choice(family, member, item + 2), kind);
    }
  }
  constexpr FurnitureKind kWallPieces[] = {FurnitureKind::bin, FurnitureKind::box, FurnitureKind::bin};
  for (const Leg& leg : layout.legs) {
    const Place stretch{
        .leg = leg, .s0_m = 0, .t0_m = -leg.width_m / 2, .s1_m = leg.length_m, .t1_m = leg.width_m / 2};
    const int wanted = static_cast<int>(std::lround(c.wall_clutter * leg.length_m / 2));
    for (int k = 0; k < wanted; ++k) {
      const auto member = static_cast<uint64_t>(leg.index / 2),
                 item = static_cast<uint64_t>(4 * k + 100000 * (leg.index % 2));
      const auto kind = kWallPieces[static_cast<size_t>(3 * sides.choice("wall clutter", member, item))];
      const int wall = sides.choice("wall clutter", member, item + 1) < 0.5 ? 1 : 3;
      place_at_wall(furnisher, space, world.floor, stretch, wall,
                    sides.choice("wall clutter", member, item + 2), kind);
    }
  }
}

}  // namespace vsslam

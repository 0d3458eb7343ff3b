#include "worlds/indoor/room.h"

#include <cmath>
#include <numbers>

#include "worlds/indoor/furniture.h"
#include "worlds/indoor/indoor_world.h"
#include "worlds/route.h"

namespace vsslam {

namespace {

constexpr double kDoorTop_m = 2.1, kRecess_m = 0.3;

struct Piece {
  FurnitureKind kind;
  double x_m, y_m;  // from the middle of the room
  int quarter_turns;
};

FloorPlan plan_room(const RoomConfig& c, const IndoorPalette& palette) {
  const double x = c.length_m / 2, y = c.width_m / 2;
  const Finish wall = palette.room_walls.front(), frame{palette.door_frame, 1, 1};
  FloorPlan plan{.areas = {{.rect = {-x, -y, x, y},
                            .ceiling_m = c.height_m,
                            .floor = palette.corridor_floor,
                            .ceiling = palette.ceiling,
                            .walls = {wall}},
                           {.rect = {-2.0, y, -0.9, y + kRecess_m},
                            .ceiling_m = kDoorTop_m,
                            .floor = palette.corridor_floor,
                            .ceiling = frame,
                            .walls = {frame}}},
                 .solids = {{x - 0.9, y - 0.9, x - 0.5, y - 0.5}, {-0.25, -0.2, 0.25, 0.3}},
                 .solid_finish = palette.pillar,
                 .tessellation_m = c.tessellation_m};
  plan.wall_panels = {
      {Facing::south, y + kRecess_m, -2.0, -0.9, 0, kDoorTop_m, palette.doors.front()},
      {Facing::south, y, 1.0, 1.6, 1.1, 1.9, palette.posters[0]},
      {Facing::west, x, -1.8, -1.2, 1.1, 1.9, palette.posters[1]},
      {Facing::west, x, 0.4, 1.6, 1.1, 1.9, palette.glass},
      {Facing::north, -y, -2.4, -1.8, 1.1, 1.9, palette.posters[2]},
      {Facing::north, -y, 1.2, 1.4, 1.6, 1.9, palette.extinguisher_sign},
      {Facing::east, -x, -0.7, -0.1, 1.1, 1.9, palette.posters[3]},
      {Facing::south, y, -1.75, -1.15, 2.2, 2.45, palette.exit_sign},
  };
  return plan;
}

void hang_lamps(World& world, FloorPlan& plan, const RoomConfig& c, const IndoorPalette& palette) {
  for (const double x : {-c.length_m / 4, c.length_m / 4})
    for (const double y : {-c.width_m / 4, c.width_m / 4}) {
      plan.ceiling_panels.push_back({{x - 0.6, y - 0.15, x + 0.6, y + 0.15}, palette.lamp});
      world.lights.push_back(ceiling_lamp("lamp", world.lights.size() + 1, {x, y, c.height_m}, 1.2 * 0.3));
    }
}

// Along the walls, and a little in the middle; everything stays off the loop.
std::vector<Piece> pieces_of(const RoomConfig& c) {
  const double x = c.length_m / 2, y = c.width_m / 2;
  return {{FurnitureKind::cupboard, -x + 0.26, 2.2, 0}, {FurnitureKind::cupboard, -x + 0.26, 3.3, 0},
          {FurnitureKind::table, 1.1, 0.8, 1},          {FurnitureKind::boxes, x - 0.35, -y + 0.45, 2},
          {FurnitureKind::box, x - 0.35, -y + 1.2, 2},  {FurnitureKind::plant, -x + 0.35, -y + 0.35, 0},
          {FurnitureKind::bench, 3.2, y - 0.3, 3},      {FurnitureKind::bin, -2.6, y - 0.25, 3},
          {FurnitureKind::round_pillar, -1.6, 0.9, 0},  {FurnitureKind::bench, -2.6, -y + 0.3, 1},
          {FurnitureKind::plant, x - 0.35, 2.4, 2},     {FurnitureKind::boxes, -1.0, -0.9, 1}};
}

}  // namespace

void RoomConfig::fields(Fields& f) {
  f("length_m", length_m, between(10, 200));
  f("width_m", width_m, between(9, 200));
  f("height_m", height_m, between(2.95, 20));
  f("clutter", clutter, between(0, 1));
  f("floor_unevenness_m", floor_unevenness_m, between(0, 0.1));
  f("floor_wavelength_m", floor_wavelength_m, between(0.5, 100));
  f("tessellation_m", tessellation_m, between(0.1, 100));
  f("textures", textures);
  f("seed", seed);
}

World make_room(const RoomConfig& c) {
  World world;
  world.name = "room";
  world.floor = {.unevenness_m = c.floor_unevenness_m, .wavelength_m = c.floor_wavelength_m, .seed = c.seed};
  IndoorPalette palette = make_indoor_palette(c.seed, c.height_m, c.textures);

  FloorPlan plan = plan_room(c, palette);
  hang_lamps(world, plan, c, palette);
  add_shell(world, build_shell(plan, world.floor));

  const double x = c.length_m / 2 - 2.3, y = c.width_m / 2 - 2.0;
  world.routes.push_back(rounded_loop("loop", {{x, -y, 0}, {x, y, 0}, {-x, y, 0}, {-x, -y, 0}}, 1.2, 0.5));

  Furnisher furnisher(world, palette, c.height_m);
  const std::vector<Piece> pieces = pieces_of(c);
  const auto kept = static_cast<size_t>(std::lround(c.clutter * static_cast<double>(pieces.size())));
  for (size_t i = 0; i < kept; ++i) {
    const Piece& p = pieces[i];
    const double foot_m = world.floor.height(p.x_m, p.y_m) - 2 * c.floor_unevenness_m;
    furnisher.place(p.kind, {p.x_m, p.y_m, foot_m}, p.quarter_turns * std::numbers::pi / 2);
  }
  adopt_palette(world, std::move(palette));
  return world;
}

}  // namespace vsslam

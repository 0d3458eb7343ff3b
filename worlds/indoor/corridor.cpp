#include "worlds/indoor/corridor.h"

#include "worlds/indoor/corridor_fittings.h"
#include "worlds/indoor/corridor_layout.h"
#include "worlds/indoor/indoor_world.h"

namespace vsslam {

void CorridorConfig::fields(Fields& f) {
  f.choice("layout", layout, {{"ring", Layout::ring}, {"straight", Layout::straight}});
  f("length_m", length_m, between(8, 2000));
  f("breadth_m", breadth_m, between(8, 2000));
  f("width_m", width_m, between(1.6, 20));
  f("height_m", height_m, between(2.5, 20));
  f("door_spacing_m", door_spacing_m, between(0, 1000));
  f("jamb_depth_m", jamb_depth_m, between(0, 1));
  f("glass_share", glass_share, between(0, 1));
  f("alcoves", alcoves, between(0, 200));
  f("alcove_width_m", alcove_width_m, between(0.2, 20));
  f("alcove_depth_m", alcove_depth_m, between(0.1, 5));
  f("lobbies", lobbies, between(0, 20));
  f("lobby_length_m", lobby_length_m, between(2, 40));
  f("lobby_width_m", lobby_width_m, between(1.6, 40));
  f("corner_extra_m", corner_extra_m, between(0, 10));
  f("symmetry", symmetry, between(0, 1));
  f("aliasing", aliasing, between(0, 1));
  f("clutter", clutter, between(0, 1));
  f("wall_clutter", wall_clutter, between(0, 1));
  f("lamp_spacing_m", lamp_spacing_m, between(2, 1000));
  f("floor_unevenness_m", floor_unevenness_m, between(0, 0.1));
  f("floor_wavelength_m", floor_wavelength_m, between(0.5, 100));
  f("tessellation_m", tessellation_m, between(0.1, 100));
  f("textures", textures);
  f("seed", seed);
  f.check(door_spacing_m == 0 || door_spacing_m >= 1.6, "door_spacing_m", "0, or at least 1.6 m");
  if (layout != Layout::ring) return;
  const double room_m = 1.25 * (lobby_width_m - width_m);
  f.check(breadth_m >= width_m + 2 * corner_extra_m + 2, "breadth_m", "room for two corner rooms");
  f.check(breadth_m >= width_m + 2 * (room_m > 0 ? room_m : 0) + 1, "breadth_m",
          "room for the lobbies between the long sides");
  f.check(breadth_m >= width_m + 2 * alcove_depth_m * (alcoves > 0) + 1, "breadth_m",
          "room for the alcoves between the long sides");
  f.check(length_m >= width_m + 2 * corner_extra_m + lobbies * 1.25 * lobby_length_m + 2, "length_m",
          "room for the lobbies between the corner rooms");
}

World make_corridor(const CorridorConfig& c) {
  World world;
  world.name = "corridor";
  world.floor = {.unevenness_m = c.floor_unevenness_m, .wavelength_m = c.floor_wavelength_m, .seed = c.seed};
  IndoorPalette palette = make_indoor_palette(c.seed, c.height_m, c.textures);
  const CorridorLayout layout = lay_out(c);

  FloorPlan plan{.areas = areas_of(layout, c, palette),
                 .solid_finish = palette.pillar,
                 .tessellation_m = c.tessellation_m};
  fit_pillars(plan, layout, c);
  fit_walls(plan, layout, c, palette);
  fit_lamps(plan, world.lights, layout, c, palette);

  world.routes = layout.routes;
  add_shell(world, build_shell(plan, world.floor));
  furnish(world, plan, layout, c, palette);
  adopt_palette(world, std::move(palette));
  return world;
}

}  // namespace vsslam

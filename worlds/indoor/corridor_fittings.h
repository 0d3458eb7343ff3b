// What corridors carry: doors, posters and signs on the walls, lamps, and furniture that leaves the routes
// free.
#pragma once

#include "worlds/indoor/corridor_layout.h"
#include "worlds/indoor/furniture.h"

namespace vsslam {

/// Doors (recessed ones add areas), glass panes, posters and signs.
void fit_walls(FloorPlan& plan, const CorridorLayout& layout, const CorridorConfig& config,
               const IndoorPalette& palette);
/// Ceiling panels and the lights in them.
void fit_lamps(FloorPlan& plan, std::vector<Light>& lights, const CorridorLayout& layout,
               const CorridorConfig& config, const IndoorPalette& palette);
/// Square pillars of lobbies and corner rooms.
void fit_pillars(FloorPlan& plan, const CorridorLayout& layout, const CorridorConfig& config);
/// Furniture at least kRouteClearance_m from every route.
void furnish(World& world, const FloorPlan& plan, const CorridorLayout& layout, const CorridorConfig& config,
             const IndoorPalette& palette);

inline constexpr double kRouteClearance_m = 0.8;

}  // namespace vsslam

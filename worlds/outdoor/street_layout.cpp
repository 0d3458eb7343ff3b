#include "worlds/outdoor/street_layout.h"

#include <utility>

#include "worlds/route.h"

namespace vsslam {

namespace {

constexpr double kEdgeDepth_m = 22, kTurnRadius_m = 4, kRouteSpacing_m = 1;

bool on_lawn(int column, int row) {
  return row == 1 && (column == 1 || column == 2);
}

void add_roads(const StreetConfig& c, StreetLayout& layout) {
  const double half = c.road_width_m / 2;
  for (int j = 0; j <= c.rows; ++j) {
    const Vec3 a = crossing(c, 0, j), b = crossing(c, c.columns, j);
    layout.roads.push_back({a.x() - half, a.y() - half, b.x() + half, b.y() + half});
  }
  for (int i = 0; i <= c.columns; ++i)
    for (int j = 0; j < c.rows; ++j) {
      if (i == 2 && j == 1) continue;  // the lawn
      const Vec3 a = crossing(c, i, j), b = crossing(c, i, j + 1);
      layout.roads.push_back({a.x() - half, a.y() + half, b.x() + half, b.y() - half});
    }
}

Block block_at(const StreetConfig& c, int i, int j) {
  const double half = c.road_width_m / 2;
  const Vec3 low = crossing(c, i, j), high = crossing(c, on_lawn(i, j) ? 3 : i + 1, j + 1);
  Rect r{low.x() + half, low.y() + half, high.x() - half, high.y() - half};
  const bool west = i < 0, east = i == c.columns, south = j < 0, north = j == c.rows;
  if (west) r.x0 = r.x1 - kEdgeDepth_m;
  if (east) r.x1 = r.x0 + kEdgeDepth_m;
  if (south) r.y0 = r.y1 - kEdgeDepth_m;
  if (north) r.y1 = r.y0 + kEdgeDepth_m;
  const bool across = west || east, along = south || north;
  return {.kind = across && along   ? Block::Kind::corner
                  : across || along ? Block::Kind::edge
                  : on_lawn(i, j)   ? Block::Kind::lawn
                                    : Block::Kind::houses,
          .rect = r,
          .front = west    ? Facing::east
                   : east  ? Facing::west
                   : south ? Facing::north
                           : Facing::south};
}

void add_blocks(const StreetConfig& c, StreetLayout& layout) {
  for (int j = -1; j <= c.rows; ++j)
    for (int i = -1; i <= c.columns; ++i)
      if (!(i == 2 && j == 1)) layout.blocks.push_back(block_at(c, i, j));
}

// All sides of inner blocks, and the front of those at the edge.
void add_roadsides(StreetLayout& layout) {
  for (const Block& block : layout.blocks) {
    if (block.kind == Block::Kind::corner) continue;
    const Rect& r = block.rect;
    const Vec3 corners[] = {{r.x1, r.y0, 0}, {r.x1, r.y1, 0}, {r.x0, r.y1, 0}, {r.x0, r.y0, 0}};
    const Vec3 out[] = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX(), -Vec3::UnitY()};
    for (size_t side = 0; side < 4; ++side)
      if (block.kind != Block::Kind::edge || static_cast<Facing>(side) == block.front)
        layout.roadsides.push_back({corners[(side + 1) % 4], corners[side], out[side]});
  }
}

std::vector<Route> routes_of(const StreetConfig& c) {
  const auto through = [&](const std::vector<std::pair<int, int>>& crossings) {
    std::vector<Vec3> points;
    for (const auto& [i, j] : crossings) points.push_back(crossing(c, i, j));
    return points;
  };
  const int east = c.columns, north = c.rows;
  const Vec3 margin(17, 0, 0);
  return {
      straight_route("avenue", crossing(c, 0, 0) + margin, crossing(c, east, 0) - margin, kRouteSpacing_m),
      rounded_loop("lawn",
                   through({{3, 1}, {3, 2}, {1, 2}, {1, 0}, {east, 0}, {east, north}, {1, north}, {1, 1}}),
                   kTurnRadius_m, kRouteSpacing_m),
      rounded_path("zigzag",
                   through({{0, north}, {0, 2}, {1, 2}, {1, north}, {2, north}, {2, 2}, {0, 2}, {0, north}}),
                   kTurnRadius_m, kRouteSpacing_m)};
}

}  // namespace

Vec3 crossing(const StreetConfig& c, int column, int row) {
  return {(column - 0.5 * c.columns) * c.pitch_x_m, (row - 0.5 * c.rows) * c.pitch_y_m, 0};
}

StreetLayout lay_out(const StreetConfig& c) {
  StreetLayout layout;
  add_roads(c, layout);
  add_blocks(c, layout);
  add_roadsides(layout);
  layout.routes = routes_of(c);
  return layout;
}

}  // namespace vsslam

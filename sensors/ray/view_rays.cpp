#include "sensors/ray/view_rays.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vsslam {

namespace {

constexpr float kLeastForward = 0.05f;
constexpr float kMargin = 1e-5f;  // of the bounds, so that rounding cannot put a ray outside

RayTile tile_of(const std::vector<Vec3f>& directions, int width_px, int height_px, int left, int top) {
  RayTile tile;
  tile.low_x = tile.low_y = std::numeric_limits<float>::max();
  tile.high_x = tile.high_y = std::numeric_limits<float>::lowest();
  tile.narrow = true;
  for (int i = 0; i < RayTile::kRays; ++i) {
    const int x = std::min(width_px - 1, left + RayTile::pixel_x(i)),
              y = std::min(height_px - 1, top + RayTile::pixel_y(i));
    const Vec3f& d =
        directions[static_cast<size_t>(y) * static_cast<size_t>(width_px) + static_cast<size_t>(x)];
    tile.x[i] = d.x(), tile.y[i] = d.y(), tile.z[i] = d.z();
    tile.narrow &= d.z() > kLeastForward;
    tile.low_x = std::min(tile.low_x, d.x() / d.z() - kMargin);
    tile.high_x = std::max(tile.high_x, d.x() / d.z() + kMargin);
    tile.low_y = std::min(tile.low_y, d.y() / d.z() - kMargin);
    tile.high_y = std::max(tile.high_y, d.y() / d.z() + kMargin);
  }
  return tile;
}

}  // namespace

ViewRays::ViewRays(int width, int height, std::vector<Vec3f> directions, float pixel_angle)
    : width_px(width),
      height_px(height),
      direction_camera(std::move(directions)),
      pixel_angle_rad(pixel_angle),
      tile_columns((width + RayTile::kSide_px - 1) / RayTile::kSide_px),
      tile_rows((height + RayTile::kSide_px - 1) / RayTile::kSide_px) {
  tiles.reserve(static_cast<size_t>(tile_columns) * static_cast<size_t>(tile_rows));
  for (int row = 0; row < tile_rows; ++row)
    for (int column = 0; column < tile_columns; ++column)
      tiles.push_back(
          tile_of(direction_camera, width, height, column * RayTile::kSide_px, row * RayTile::kSide_px));
}

}  // namespace vsslam

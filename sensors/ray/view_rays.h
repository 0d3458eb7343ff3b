// The rays of a camera's pixels, and the tiles that they are traced in.
#pragma once

#include <vector>

#include "worlds/world.h"

namespace vsslam {

/// Rays of 8 x 8 pixels in the camera frame (x right, y down, z forward), in blocks of 4 x 2 pixels: down the left
/// half of the tile first. Beyond the image's edge its last pixels are repeated.
struct alignas(32) RayTile {
  static constexpr int kSide_px = 8, kRays = 64, kBlockWidth_px = 4, kBlockHeight_px = 2;
  float x[kRays], y[kRays], z[kRays];  ///< unit vectors
  float low_x, high_x, low_y, high_y;  ///< of x / z and y / z
  bool narrow = false;                 ///< all rays go forward: the bounds above hold
  static int pixel_x(int ray) { return ray / 32 * 4 + ray % 4; }
  static int pixel_y(int ray) { return ray % 32 / 4; }
};

/// The rays of a camera's pixels, row-major. Camera frame: x right, y down, z forward.
struct ViewRays {
  /// Unit directions through the pixels' centres; width and height are multiples of 4.
  ViewRays(int width_px, int height_px, std::vector<Vec3f> direction_camera, float pixel_angle_rad);

  int width_px = 0, height_px = 0;
  std::vector<Vec3f> direction_camera;
  float pixel_angle_rad = 0;  ///< angle between neighbouring rays at the image's centre
  int tile_columns = 0, tile_rows = 0;
  std::vector<RayTile> tiles;  ///< row-major
};

}  // namespace vsslam

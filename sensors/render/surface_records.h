// What shading knows of each triangle.
#pragma once

#include <cstdint>
#include <vector>

#include "sensors/surface/light_map_charts.h"
#include "sensors/surface/texture_filter.h"

namespace vsslam {

/// All that shading needs of a triangle: rows of eight numbers. The first four are read in one go where eight rays hit
/// as many triangles; the last serves beams.
struct alignas(32) SurfaceRecord {
  float uv[3][2];                      ///< texture coordinates of the corners
  float width_px, height_px;           ///< of the texture
  float u_gradient[3], v_gradient[3];  ///< texels per m in the world
  float luminance;                     ///< that it emits now
  int32_t first_level;                 ///< of its texture
  float normal[3];                     ///< world, unit
  float light[3][2];                   ///< corners on the light map, in nodes
  int32_t light_offset, light_stride;
  int32_t levels;
  float light_x_gradient[3], light_y_gradient[3];  ///< nodes per m in the world
  float corner[3];                                 ///< the first, world
  float light_high[2];                             ///< last node of its chart
  float unused;
};
static_assert(sizeof(SurfaceRecord) == 40 * sizeof(float));

/// Of each triangle, and at the end one that stands for nothing at all.
std::vector<SurfaceRecord> surface_records(const PlacedTriangles& triangles, const LightMapCharts& charts,
                                           const GreyTextures& textures);

}  // namespace vsslam

// From what packets of rays hit to the luminance that comes back along them.
#pragma once

#include <vector>

#include "sensors/light_map_charts.h"
#include "sensors/light_sources.h"
#include "sensors/raycaster.h"
#include "sensors/texture_filter.h"

namespace vsslam {

/// All that shading needs of a triangle: four rows of eight numbers, to be read in one go.
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
  float unused[4];
};
static_assert(sizeof(SurfaceRecord) == 32 * sizeof(float));

/// Of each triangle, and at the end one that stands for nothing at all.
std::vector<SurfaceRecord> surface_records(const PlacedTriangles& triangles, const LightMapCharts& charts,
                                           const GreyTextures& textures);

/// Where a picture is taken from; axes in the world.
struct Viewpoint {
  Vec3f right, down, axis;
  float pixel_angle_rad;
};

struct Surfaces {
  const GreyTextures& textures;
  const std::vector<SurfaceRecord>& records;
  const std::vector<size_t>& first_of_object;
  const std::vector<float>& illuminance;  ///< of the light map's nodes; a row longer than these
  float headlight_cd, headlight_cos_inner, headlight_cos_outer;
  Sky sky;
};

struct ShadedPacket {
  float luminance[16];  ///< cd/m^2
  float depth_m[16];    ///< along the axis; infinity: nothing hit
};
void shade(const Surfaces& surfaces, const Viewpoint& view, const RayPacket& rays, const SurfacePacket& hits,
           ShadedPacket& shaded);

}  // namespace vsslam

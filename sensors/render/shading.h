// From what rays hit to the luminance that comes back along them.
#pragma once

#include <vector>

#include "sensors/light/light_sources.h"
#include "sensors/ray/raycaster.h"
#include "sensors/render/beam.h"
#include "sensors/render/surface_records.h"
#include "sensors/surface/texture_filter.h"

namespace vsslam {

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

struct alignas(32) ShadedTile {
  float luminance[RayTile::kRays];  ///< cd/m^2
  float depth_m[RayTile::kRays];    ///< along the axis; infinity: nothing hit
};
/// The rays of a packet, which are those of the tile from `first` on.
void shade(const Surfaces& surfaces, const Viewpoint& view, const RayPacket& rays, const SurfacePacket& hits,
           int first, ShadedTile& shaded);
/// The rays of a beam, one triangle after another. `tile` is what the beam was made of.
void shade(const Surfaces& surfaces, const Viewpoint& view, const RayTile& tile, const Beam& beam,
           const BeamHits& hits, ShadedTile& shaded);

}  // namespace vsslam

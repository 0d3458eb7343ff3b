// What shines in a world: its lights and its luminous surfaces, in groups that are switched together.
#pragma once

#include <string>
#include <vector>

#include "sensors/surface/placed_triangles.h"
#include "worlds/lighting.h"

namespace vsslam {

/// One light as the light maps see it; levels of the preset are included.
struct LightSource {
  enum class Kind {
    point,
    spot,
    directional,
    surface
  };  ///< surface: a small piece that shines by Lambert's law
  Kind kind = Kind::point;
  int group = 0;
  Vec3f position_world = Vec3f::Zero(), direction_world = -Vec3f::UnitZ();
  float intensity = 0;  ///< grey cd; lux if directional
  float radius_m = 0, range_m = 0;
  float cos_inner = 1, cos_outer = 0;
  float upwards = 1;  ///< what goes up against what goes down: through a window the ground is seen from above

  /// Illuminance (lux) of a surface at `position` that faces `normal`, as if nothing stood between.
  float illuminance(const Vec3f& position_world, const Vec3f& normal_world) const;
};

/// What a triangle emits.
struct Glow {
  size_t triangle = 0;
  int group = 0;
  float luminance = 0;    ///< grey cd/m^2
  bool gathered = false;  ///< lights others by being hit: no source stands for it
};

/// Overcast sky (CIE): three times as bright in the zenith as at the horizon; dim ground below. About the sun
/// (the strongest directional light) air and thin clouds glow: half as bright 7 degrees beside it.
struct Sky {
  float zenith = 0;  ///< cd/m^2
  float sun_lux = 0;
  Vec3f to_sun = Vec3f::UnitZ();

  static constexpr float kBelowHorizon = 0.07f;
  static constexpr float kGlow = 0.35f;  ///< at the sun, cd/m^2 for each lux of it (judgement)
  static constexpr float kGlowRadius2_rad2 = 0.04f;
  float dome(float direction_z) const {
    return zenith * (direction_z > 0 ? (1 + 2 * direction_z) / 3 : kBelowHorizon);
  }
};

struct LightSources {
  LightSources(const World& world, const PlacedTriangles& triangles, const Illumination& lit);

  std::vector<std::string>
      groups;  ///< of lights in alphabetical order; then "emissive", "daylight", "headlight"
  std::vector<LightSource> sources;
  std::vector<Glow> glows;                        ///< in order of triangles
  int daylight_group = -1, headlight_group = -1;  ///< -1: there is none
  int sun_group = -1;
  Sky sky;
  bool ambient = false;
};

}  // namespace vsslam

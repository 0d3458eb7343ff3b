#include "sensors/light/light_sources.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "sensors/surface/texture_filter.h"

namespace vsslam {

namespace {

constexpr float kLargestSource_m2 = 1;  // larger luminous surfaces are found by rays
constexpr float kGroundAgainstSky = 0.15f;
constexpr size_t kMostSources = 4096;  // and so are very many small ones

LightSource source_of(const Light& light, double level, int group) {
  LightSource s;
  s.kind = light.kind == Light::Kind::spot          ? LightSource::Kind::spot
           : light.kind == Light::Kind::directional ? LightSource::Kind::directional
                                                    : LightSource::Kind::point;
  s.group = group;
  s.position_world = light.position_world.cast<float>();
  s.direction_world = light.direction_world.cast<float>().normalized();
  s.intensity = static_cast<float>(level * light.intensity) * grey(light.color);
  s.radius_m = static_cast<float>(light.radius_m);
  s.range_m = static_cast<float>(light.range_m);
  s.cos_inner = static_cast<float>(std::cos(light.inner_cone_rad));
  s.cos_outer = static_cast<float>(std::cos(light.outer_cone_rad));
  return s;
}

LightSource source_of(const PlacedTriangle& triangle, const Glow& glow) {
  LightSource s;
  s.kind = LightSource::Kind::surface;
  s.group = glow.group;
  const auto& c = triangle.corners_world;
  s.position_world = (c[0] + c[1] + c[2]) / 3 + 1e-3f * triangle.normal_world;
  s.direction_world = triangle.normal_world;
  s.intensity = glow.luminance * triangle.area_m2;
  s.radius_m = std::sqrt(triangle.area_m2 / std::numbers::pi_v<float>);
  return s;
}

/// The level of that light of the group which hangs nearest to a lamp's luminous surface.
double level_of_nearest(const World& world, const Illumination& lit, const PlacedTriangle& triangle,
                        const std::string& group) {
  const Vec3 at = ((triangle.corners_world[0] + triangle.corners_world[1] + triangle.corners_world[2]) / 3)
                      .cast<double>();
  double nearest2 = 1e300, level = 1;
  for (size_t i = 0; i < world.lights.size(); ++i) {
    const double distance2 = (world.lights[i].position_world - at).squaredNorm();
    if (world.lights[i].group == group && distance2 < nearest2)
      nearest2 = distance2, level = lit.light_level[i];
  }
  return level;
}

}  // namespace

float LightSource::illuminance(const Vec3f& position, const Vec3f& normal) const {
  if (kind == Kind::directional) return intensity * std::max(0.0f, -direction_world.dot(normal));
  const Vec3f to_light = position_world - position;
  const float distance2 = std::max(to_light.squaredNorm(), 1e-4f), distance = std::sqrt(distance2);
  if (range_m > 0 && distance > range_m) return 0;
  const float cos_surface = to_light.dot(normal) / distance;
  if (cos_surface <= 0) return 0;
  const float cos_light = -to_light.dot(direction_world) / distance;
  if (kind == Kind::point) return intensity * cos_surface / distance2;
  if (cos_light <= 0) return 0;
  if (kind == Kind::surface) {
    const float height =
        std::clamp(0.5f - 2 * to_light.z() / distance, 0.0f, 1.0f);  // 1: well above the source
    const float share = 1 + height * (upwards - 1);
    // A disc's illuminance on its axis has radius^2 + distance^2 below it.
    return intensity * share * cos_light * cos_surface / (distance2 + radius_m * radius_m);
  }
  // KHR_lights_punctual, reference code of the spot's edge.
  const float edge = std::clamp((cos_light - cos_outer) / std::max(1e-3f, cos_inner - cos_outer), 0.0f, 1.0f);
  return intensity * edge * edge * cos_surface / distance2;
}

LightSources::LightSources(const World& world, const PlacedTriangles& triangles, const Illumination& lit)
    : ambient(lit.ambient) {
  sky.zenith = static_cast<float>(lit.sky_luminance_cdpm2);
  std::set<std::string> of_lights;
  for (const Light& light : world.lights) of_lights.insert(light.group);
  groups.assign(of_lights.begin(), of_lights.end());
  const auto group = [this](const std::string& name) {
    const auto it = std::find(groups.begin(), groups.end(), name);
    if (it == groups.end()) groups.push_back(name);
    return static_cast<int>(std::find(groups.begin(), groups.end(), name) - groups.begin());
  };
  for (size_t i = 0; i < world.lights.size(); ++i) {
    sources.push_back(source_of(world.lights[i], lit.light_level[i], group(world.lights[i].group)));
    const LightSource& s = sources.back();
    if (s.kind != LightSource::Kind::directional || s.intensity <= sky.sun_lux) continue;
    sky.sun_lux = s.intensity;
    sky.to_sun = -s.direction_world;
    sun_group = s.group;
  }

  size_t small = 0;
  for (size_t t = 0; t < triangles.all.size(); ++t) {
    const PlacedTriangle& triangle = triangles.all[t];
    const Material& m = world.materials[static_cast<size_t>(triangle.material)];
    Glow glow{.triangle = t, .luminance = grey(m.emissive), .gathered = !of_lights.contains(m.name)};
    if (m.glass && lit.glass_luminance_cdpm2 > 0) {
      glow.luminance = static_cast<float>(lit.glass_luminance_cdpm2);
      glow.group = group("daylight");
    } else if (!(glow.luminance > 0)) {
      continue;
    } else if (glow.gathered) {
      glow.group = group("emissive");
    } else {
      glow.group = group(m.name);
      glow.luminance *= static_cast<float>(level_of_nearest(world, lit, triangle, m.name));
    }
    small += glow.gathered && triangle.area_m2 <= kLargestSource_m2;
    glows.push_back(glow);
  }
  for (Glow& glow : glows) {
    if (!glow.gathered || small > kMostSources || triangles.all[glow.triangle].area_m2 > kLargestSource_m2)
      continue;
    glow.gathered = false;
    sources.push_back(source_of(triangles.all[glow.triangle], glow));
    const bool window = world.materials[static_cast<size_t>(triangles.all[glow.triangle].material)].glass;
    if (window) sources.back().upwards = kGroundAgainstSky;
  }
  if (sky.zenith > 0) daylight_group = group("daylight");
  if (lit.headlight.intensity_cd > 0) headlight_group = group("headlight");
}

}  // namespace vsslam

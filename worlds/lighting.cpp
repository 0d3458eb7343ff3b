#include "worlds/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rng.h"

namespace vsslam {

namespace {

using Preset = LightingConfig::Preset;

bool is_daylight(const Light& light) {
  return light.kind == Light::Kind::directional;
}
bool is_emergency(const Light& light) {
  return light.group.starts_with("emergency");
}

// One draw per square of the plan says whether its lamps burn, one per lamp how old it is.
double non_uniform_level(const LightingConfig& c, const Light& light, size_t index) {
  const auto square = [&](double m) {
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(m / c.off_stretch_m)));
  };
  const double on = RandomStream(c.seed, "lamps off")
                        .uniform(square(light.position_world.x()), square(light.position_world.y()));
  const double age = RandomStream(c.seed, "lamp age").uniform(index);
  return on < c.off_share ? 0.0 : 1 - (1 - c.dimmest_level) * age;
}

double sky_level(const LightingConfig& c) {
  return c.preset == Preset::low ? c.low_level : c.preset == Preset::dark ? c.night_level : 1.0;
}

// At dusk the sun has set and the sky is left; by night it stands for the moon.
double sun_level(const LightingConfig& c) {
  switch (c.preset) {
    case Preset::low:
      return 0;
    case Preset::dark:
      return c.night_level;
    case Preset::bright:
      return c.bright_level;
    default:
      return 1;
  }
}

double level(const LightingConfig& c, const Light& light, size_t index, bool outdoors) {
  if (is_daylight(light)) return sun_level(c);
  if (is_emergency(light)) return 1;
  if (outdoors && (c.preset == Preset::low || c.preset == Preset::dark)) return 1;
  switch (c.preset) {
    case Preset::even:
      return 1;
    case Preset::non_uniform:
      return non_uniform_level(c, light, index);
    case Preset::low:
      return c.low_level;
    case Preset::dark:
      return 0;
    case Preset::bright:
      return c.bright_level;
  }
  return 1;
}

}  // namespace

void LightingConfig::fields(Fields& f) {
  f.choice("preset", preset,
           {{"even", Preset::even},
            {"non_uniform", Preset::non_uniform},
            {"low", Preset::low},
            {"dark", Preset::dark},
            {"bright", Preset::bright}});
  f("seed", seed);
  f("off_share", off_share, between(0, 1));
  f("off_stretch_m", off_stretch_m, between(0.5, 1000));
  f("dimmest_level", dimmest_level, between(0, 1));
  f("low_level", low_level, between(0, 1));
  f("bright_level", bright_level, between(1, 1000));
  f("window_luminance_cdpm2", window_luminance_cdpm2, between(0, 1e6));
  f("sky_luminance_cdpm2", sky_luminance_cdpm2, between(0, 1e5));
  f("night_level", night_level, between(0, 1));
  f.choice("headlight", headlight,
           {{"automatic", Switch::automatic}, {"on", Switch::on}, {"off", Switch::off}});
  f("headlight_intensity_cd", headlight_intensity_cd, between(0, 1e5));
  f("headlight_cone_deg", headlight_cone_deg, between(1, 89));
}

Illumination illuminate(const World& world, const LightingConfig& c) {
  Illumination lit;
  const bool outdoors = std::any_of(world.lights.begin(), world.lights.end(), is_daylight);
  for (size_t i = 0; i < world.lights.size(); ++i)
    lit.light_level.push_back(level(c, world.lights[i], i, outdoors));
  const bool emits = std::any_of(world.materials.begin(), world.materials.end(),
                                 [](const Material& m) { return m.emissive.maxCoeff() > 0; });
  lit.ambient = world.lights.empty() && !emits;
  if (lit.ambient || outdoors) lit.sky_luminance_cdpm2 = c.sky_luminance_cdpm2 * sky_level(c);
  if (c.preset == Preset::bright) lit.glass_luminance_cdpm2 = c.window_luminance_cdpm2;
  const bool headlight = c.headlight == LightingConfig::Switch::automatic
                             ? c.preset == Preset::dark
                             : c.headlight == LightingConfig::Switch::on;
  if (headlight) lit.headlight = {c.headlight_intensity_cd, c.headlight_cone_deg * std::numbers::pi / 180};
  return lit;
}

}  // namespace vsslam

#include "worlds/lighting.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "worlds/indoor/corridor.h"
#include "worlds/indoor/room.h"

namespace vsslam {
namespace {

using Preset = LightingConfig::Preset;

Illumination lit(const World& world, Preset preset) {
  LightingConfig config;
  config.preset = preset;
  return illuminate(world, config);
}

World corridor() {
  CorridorConfig config;
  config.textures = false;
  return make_corridor(config);
}

World plain_room() {
  RoomConfig config;
  config.textures = false;
  return make_room(config);
}

std::vector<double> lamps(const World& world, const Illumination& illumination, const std::string& group) {
  std::vector<double> levels;
  for (size_t i = 0; i < world.lights.size(); ++i)
    if (world.lights[i].group == group) levels.push_back(illumination.light_level[i]);
  return levels;
}

TEST(Lighting, PresetsSetLampsAndSpareEmergencyLamps) {
  const World world = corridor();
  const LightingConfig defaults;
  const std::pair<Preset, double> expected[] = {{Preset::even, 1},
                                                {Preset::low, defaults.low_level},
                                                {Preset::dark, 0},
                                                {Preset::bright, defaults.bright_level}};
  for (const auto& [preset, level] : expected) {
    const Illumination illumination = lit(world, preset);
    for (const double l : lamps(world, illumination, "lamp")) EXPECT_EQ(l, level);
    for (const double l : lamps(world, illumination, "emergency")) EXPECT_EQ(l, 1);
    EXPECT_EQ(illumination.headlight.intensity_cd > 0, preset == Preset::dark);
    EXPECT_EQ(illumination.glass_luminance_cdpm2 > 0, preset == Preset::bright);
    EXPECT_FALSE(illumination.ambient);
  }
}

TEST(Lighting, NonUniformLeavesStretchesDark) {
  const World world = corridor();
  LightingConfig config;
  config.preset = Preset::non_uniform;
  const std::vector<double> levels = lamps(world, illuminate(world, config), "lamp");
  const auto off = static_cast<double>(std::count(levels.begin(), levels.end(), 0.0));
  EXPECT_NEAR(off / static_cast<double>(levels.size()), config.off_share, 0.25);
  for (const double l : levels) EXPECT_TRUE(l == 0 || (l >= config.dimmest_level && l <= 1)) << l;
  EXPECT_EQ(levels, lamps(world, illuminate(world, config), "lamp"));
  config.seed = 2;
  EXPECT_NE(levels, lamps(world, illuminate(world, config), "lamp"));
}

TEST(Lighting, HeadlightIsASwitch) {
  const World world = corridor();
  LightingConfig config;
  config.headlight = LightingConfig::Switch::on;
  EXPECT_EQ(illuminate(world, config).headlight.intensity_cd, config.headlight_intensity_cd);
  config.preset = Preset::dark;
  config.headlight = LightingConfig::Switch::off;
  EXPECT_EQ(illuminate(world, config).headlight.intensity_cd, 0);
}

TEST(Lighting, TheSkyShinesWithTheSunOrWhereThereIsNoLight) {
  World world = corridor();
  EXPECT_EQ(lit(world, Preset::even).sky_luminance_cdpm2, 0);
  world.lights.push_back({.name = "sun", .kind = Light::Kind::directional, .group = "sun"});
  EXPECT_EQ(lit(world, Preset::even).sky_luminance_cdpm2, LightingConfig{}.sky_luminance_cdpm2);
  EXPECT_EQ(lit(world, Preset::even).light_level.back(), 1);
  EXPECT_EQ(lit(world, Preset::dark).light_level.back(), LightingConfig{}.night_level);
  EXPECT_FALSE(lit(world, Preset::even).ambient);
  EXPECT_TRUE(lit(World{}, Preset::even).ambient);
  EXPECT_EQ(lit(World{}, Preset::even).sky_luminance_cdpm2, LightingConfig{}.sky_luminance_cdpm2);
}

TEST(Lighting, UnderTheSkyLampsBurnAtNightAndTheSunSets) {
  World world = corridor();
  world.lights.push_back({.name = "sun", .kind = Light::Kind::directional, .group = "sun"});
  const LightingConfig defaults;
  for (const Preset preset : {Preset::low, Preset::dark})
    for (const double l : lamps(world, lit(world, preset), "lamp")) EXPECT_EQ(l, 1);
  EXPECT_EQ(lit(world, Preset::low).light_level.back(), 0);
  EXPECT_EQ(lit(world, Preset::low).sky_luminance_cdpm2, defaults.low_level * defaults.sky_luminance_cdpm2);
  EXPECT_EQ(lit(world, Preset::bright).light_level.back(), defaults.bright_level);
  EXPECT_EQ(lit(world, Preset::bright).sky_luminance_cdpm2, defaults.sky_luminance_cdpm2);
}

TEST(Lighting, PanelsGlowAsBrightlyAsTheirLightsSay) {
  for (const World& world : {corridor(), plain_room()}) {
    for (const Light& light : world.lights) {
      const auto panel = std::find_if(world.materials.begin(), world.materials.end(),
                                      [&](const Material& m) { return m.name == light.group; });
      ASSERT_NE(panel, world.materials.end());
      const double area_m2 = 3.14159265358979 * light.radius_m * light.radius_m;
      EXPECT_NEAR(light.intensity * light.color[0], panel->emissive[0] * area_m2, 1e-3 * light.intensity);
    }
  }
}

}  // namespace
}  // namespace vsslam

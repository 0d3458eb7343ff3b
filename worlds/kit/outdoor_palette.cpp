#include "worlds/kit/outdoor_palette.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "worlds/kit/indoor_textures.h"
#include "worlds/kit/outdoor_textures.h"

namespace vsslam {

namespace {

constexpr float kLampLuminance_cdpm2 = 12000, kWindowLuminance_cdpm2 = 12;
constexpr double kSun_lux = 20000;
const Vec3f kLampColor(1.0f, 0.93f, 0.8f), kWindowColor(1.0f, 0.85f, 0.6f);

class OutdoorPaletteBuilder {
 public:
  OutdoorPaletteBuilder(uint64_t seed, bool textures) : seed_(seed), builder_(textures) {}

  OutdoorPalette build() {
    add_grounds();
    add_facades();
    add_openings();
    add_plants();
    add_stuff();
    static_cast<Palette&>(palette_) = builder_.finish();
    return std::move(palette_);
  }

 private:
  using Painter = PaletteBuilder::Painter;

  int add(const std::string& name, const Paint& paint, float roughness, Painter painter = {}) {
    return builder_.add(name, paint, roughness, std::move(painter));
  }
  int stuff(const std::string& name, const Paint& paint, double cell_x_m, double cell_y_m, float contrast) {
    return add(name, paint, 0.7f, [=, seed = seed_] {
      return stuff_texture(seed, name, paint.srgb, cell_x_m, cell_y_m, contrast);
    });
  }

  void add_grounds() {
    const uint64_t seed = seed_;
    const auto slabs = [&](const std::string& name, const Paint& paint, double size_m) {
      return Finish{
          add(name, paint, 0.9f, [=] { return tiles_texture(seed, name, paint.srgb, 1024, size_m); }), size_m,
          size_m};
    };
    palette_.asphalt = {add("asphalt", {{0.34f, 0.34f, 0.35f}, 0.16f}, 0.95f,
                            [=] { return asphalt_texture(seed, "asphalt", 1024, 6); }),
                        6, 6};
    palette_.paving = slabs("paving", {{0.55f, 0.52f, 0.48f}, 0.32f}, 3.2);
    palette_.pavement = slabs("pavement", {{0.52f, 0.52f, 0.51f}, 0.35f}, 2.0);
    palette_.lawn = {
        add("lawn", {{0.33f, 0.43f, 0.21f}, 0.5f}, 1.0f, [=] { return lawn_texture(seed, "lawn", 1024, 5); }),
        5, 5};
    palette_.kerb = {stuff("kerb", {{0.62f, 0.61f, 0.58f}, 0.45f}, 0.2, 0.2, 0.2f), 1, 1};
    palette_.marking = stuff("marking", {{0.85f, 0.85f, 0.83f}, 0.7f}, 0.1, 0.1, 0.15f);
  }

  void add_facades() {
    const uint64_t seed = seed_;
    const std::pair<const char*, Paint> plasters[] = {{"plaster_1", {{0.83f, 0.78f, 0.66f}, 0.6f}},
                                                      {"plaster_2", {{0.74f, 0.61f, 0.5f}, 0.55f}},
                                                      {"plaster_3", {{0.78f, 0.79f, 0.78f}, 0.65f}},
                                                      {"plaster_4", {{0.62f, 0.66f, 0.66f}, 0.5f}}};
    for (const auto& [name, paint] : plasters)
      palette_.facades.push_back({add(name, paint, 0.95f,
                                      [=, name = std::string(name), color = paint.srgb] {
                                        return plaster_texture(seed, name, color, 1024, 6);
                                      }),
                                  6, 6});
    const std::pair<const char*, Paint> bricks[] = {{"brick_1", {{0.55f, 0.3f, 0.24f}, 0.45f}},
                                                    {"brick_2", {{0.62f, 0.5f, 0.38f}, 0.5f}}};
    for (const auto& [name, paint] : bricks)
      palette_.facades.push_back({add(name, paint, 0.95f,
                                      [=, name = std::string(name), color = paint.srgb] {
                                        return brick_texture(seed, name, color, 1024, 4);
                                      }),
                                  4, 4});
    palette_.facades.push_back({add("concrete", {{0.62f, 0.61f, 0.59f}, 0.45f}, 0.9f,
                                    [=] { return concrete_texture(seed, "concrete", 1024, 6); }),
                                6, 6});
    palette_.stone = {stuff("stone", {{0.68f, 0.66f, 0.6f}, 0.5f}, 0.3, 0.15, 0.2f), 1, 1};
    palette_.roof = {stuff("roof", {{0.35f, 0.33f, 0.32f}, 0.2f}, 0.2, 0.2, 0.2f), 1, 1};
  }

  void add_openings() {
    const uint64_t seed = seed_;
    for (int i = 1; i <= 4; ++i) {
      const std::string name = "window_" + std::to_string(i);
      palette_.windows.push_back(
          add(name, {{0.28f, 0.31f, 0.34f}, 0.06f}, 0.1f, [=] { return window_texture(seed, name); }));
    }
    palette_.lit_window = add("window_lit", {{0.8f, 0.72f, 0.55f}, 0.06f}, 0.1f,
                              [=] { return window_texture(seed, "window_lit"); });
    builder_.at(palette_.lit_window).emissive = kWindowLuminance_cdpm2 * kWindowColor;
    const Vec3f doors[] = {{0.42f, 0.28f, 0.18f}, {0.22f, 0.32f, 0.3f}, {0.5f, 0.5f, 0.52f}};
    for (int i = 0; i < 3; ++i) {
      const std::string name = "house_door_" + std::to_string(i + 1);
      palette_.doors.push_back(add(name, {doors[i], 0.4f}, 0.5f, [=, color = doors[i]] {
        return door_texture(seed, name, color, 3 + 8 * i);
      }));
    }
    for (int i = 1; i <= 4; ++i) {
      const std::string name = "banner_" + std::to_string(i);
      palette_.posters.push_back(
          add(name, {{0.8f, 0.78f, 0.74f}, 0.6f}, 0.5f, [=] { return poster_texture(seed, name); }));
    }
  }

  void add_plants() {
    const uint64_t seed = seed_;
    const Vec3f greens[] = {{0.3f, 0.44f, 0.2f}, {0.38f, 0.47f, 0.2f}, {0.24f, 0.37f, 0.22f}};
    for (int i = 0; i < 3; ++i) {
      const std::string name = "foliage_" + std::to_string(i + 1);
      palette_.foliage.push_back(add(name, {greens[i], 0.5f}, 0.9f,
                                     [=, color = greens[i]] { return leaves_texture(seed, name, color); }));
    }
    palette_.hedge = add("hedge", {{0.2f, 0.32f, 0.15f}, 0.45f}, 0.9f, [=] {
      return leaves_texture(seed, "hedge", {0.24f, 0.38f, 0.18f});
    });
    palette_.bark = stuff("bark", {{0.4f, 0.33f, 0.27f}, 0.35f}, 0.03, 0.3, 0.5f);
  }

  void add_stuff() {
    palette_.wood = stuff("planks", {{0.5f, 0.37f, 0.25f}, 0.4f}, 0.05, 0.5, 0.25f);
    palette_.steel = stuff("steel", {{0.58f, 0.59f, 0.6f}, 0.4f}, 0.2, 0.2, 0.08f);
    palette_.dark_steel = stuff("dark_steel", {{0.2f, 0.22f, 0.22f}, 0.25f}, 0.1, 0.1, 0.2f);
    const Paint paints[] = {{{0.78f, 0.78f, 0.77f}, 0.55f},
                            {{0.16f, 0.17f, 0.19f}, 0.1f},
                            {{0.52f, 0.1f, 0.1f}, 0.35f},
                            {{0.18f, 0.27f, 0.45f}, 0.25f},
                            {{0.5f, 0.52f, 0.53f}, 0.4f}};
    for (size_t i = 0; i < std::size(paints); ++i)
      palette_.car_paints.push_back(stuff("car_" + std::to_string(i + 1), paints[i], 0.5, 0.5, 0.05f));
    palette_.car_glass = add("car_glass", {{0.1f, 0.12f, 0.13f}, 0.05f}, 0.1f);
    palette_.rubber = add("rubber", {{0.12f, 0.12f, 0.12f}, 0.06f}, 0.9f);
    palette_.tail_light = add("tail_light", {{0.5f, 0.05f, 0.05f}, 0.4f}, 0.3f);
    const Paint clothes[] = {{{0.2f, 0.24f, 0.36f}, 0.3f},
                             {{0.55f, 0.2f, 0.2f}, 0.45f},
                             {{0.72f, 0.7f, 0.65f}, 0.6f},
                             {{0.15f, 0.15f, 0.16f}, 0.15f}};
    for (size_t i = 0; i < std::size(clothes); ++i)
      palette_.clothes.push_back(stuff("cloth_" + std::to_string(i + 1), clothes[i], 0.06, 0.06, 0.25f));
    palette_.skin = add("skin", {{0.75f, 0.57f, 0.46f}, 0.55f}, 0.7f);
    palette_.hair = add("hair", {{0.2f, 0.15f, 0.12f}, 0.25f}, 0.8f);
    palette_.sign = add("sign", {{0.1f, 0.3f, 0.65f}, 0.6f}, 0.3f);
    palette_.number_plate = add("number_plate", {{0.88f, 0.88f, 0.84f}, 0.6f}, 0.3f);
    for (const int m : {palette_.sign, palette_.number_plate}) builder_.at(m).retro_reflective = true;
    palette_.lamp = add("lamp", {{0.95f, 0.95f, 0.94f}, 0.7f}, 0.3f);
    builder_.at(palette_.lamp).emissive = kLampLuminance_cdpm2 * kLampColor;
  }

  uint64_t seed_;
  PaletteBuilder builder_;
  OutdoorPalette palette_;
};

}  // namespace

// Luminance times area is the intensity straight down.
Light street_light(size_t number, const Vec3& head_world, double area_m2) {
  Light light{.name = "lamp_" + std::to_string(number), .kind = Light::Kind::spot, .group = "lamp"};
  light.position_world = head_world - Vec3(0, 0, 0.05);
  light.color = kLampColor;
  light.intensity = kLampLuminance_cdpm2 * area_m2;
  light.radius_m = std::sqrt(area_m2 / std::numbers::pi);
  light.inner_cone_rad = 0.9;
  light.outer_cone_rad = 1.4;
  return light;
}

Light sunlight() {
  Light sun{.name = "sun", .kind = Light::Kind::directional, .group = "sun"};
  sun.direction_world = Vec3(-0.45, 0.5, -0.62).normalized();
  sun.color = Vec3f(1.0f, 0.97f, 0.9f);
  sun.intensity = kSun_lux;
  return sun;
}

OutdoorPalette make_outdoor_palette(uint64_t seed, bool textures) {
  return OutdoorPaletteBuilder(seed, textures).build();
}

}  // namespace vsslam

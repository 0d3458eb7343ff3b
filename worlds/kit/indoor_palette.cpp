#include "worlds/kit/indoor_palette.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "worlds/kit/indoor_textures.h"

namespace vsslam {

namespace {

constexpr float kLampLuminance_cdpm2 = 3500, kEmergencyLuminance_cdpm2 = 400;
const Vec3f kLampColor(1.0f, 0.96f, 0.88f), kEmergencyColor(0.9f, 1.0f, 0.9f);

class IndoorPaletteBuilder {
 public:
  IndoorPaletteBuilder(uint64_t seed, double wall_height_m, bool textures)
      : seed_(seed), wall_height_m_(wall_height_m), builder_(textures) {}

  IndoorPalette build() {
    add_walls();
    add_floors_and_ceiling();
    add_doors();
    add_signs();
    add_stuff();
    static_cast<Palette&>(palette_) = builder_.finish();
    return std::move(palette_);
  }

 private:
  int add(const std::string& name, const Paint& paint, float roughness,
          PaletteBuilder::Painter painter = {}) {
    return builder_.add(name, paint, roughness, std::move(painter));
  }

  int add_wall(const std::string& name, const Paint& paint, int width_px) {
    const double height_m = wall_height_m_;
    return add(name, paint, 0.9f,
               [=, seed = seed_] { return wall_texture(seed, name, paint.srgb, width_px, 4.0, height_m); });
  }

  void add_walls() {
    const Paint corridor{{0.85f, 0.83f, 0.77f}, 0.7f};
    for (int i = 1; i <= 4; ++i)
      palette_.corridor_walls.push_back(
          {add_wall("wall_" + std::to_string(i), corridor, 1024), 4.0, wall_height_m_});
    const std::array<Paint, 3> rooms = {Paint{{0.88f, 0.79f, 0.62f}, 0.65f},
                                        Paint{{0.66f, 0.76f, 0.82f}, 0.65f},
                                        Paint{{0.73f, 0.8f, 0.68f}, 0.65f}};
    for (size_t i = 0; i < rooms.size(); ++i)
      palette_.room_walls.push_back(
          {add_wall("room_wall_" + std::to_string(i + 1), rooms[i], 768), 4.0, wall_height_m_});
    const Paint concrete{{0.66f, 0.65f, 0.63f}, 0.5f};
    palette_.pillar = {add_stuff_material("pillar", concrete, 0.3, 0.3, 0.12f), 1.0, 1.0};
  }

  void add_floors_and_ceiling() {
    const auto tiles = [this](const std::string& name, const Paint& paint, int size_px) {
      return add(name, paint, 0.6f,
                 [=, seed = seed_] { return tiles_texture(seed, name, paint.srgb, size_px, 2.4); });
    };
    palette_.corridor_floor = {tiles("floor_tiles", {{0.56f, 0.55f, 0.53f}, 0.25f}, 1024), 2.4, 2.4};
    const Paint oak{{0.58f, 0.43f, 0.29f}, 0.3f}, panels{{0.86f, 0.86f, 0.84f}, 0.8f};
    palette_.room_floors = {{add("room_floor_1", oak, 0.5f,
                                 [seed = seed_] { return parquet_texture(seed, "room_floor_1", 768, 2.4); }),
                             2.4, 2.4},
                            {tiles("room_floor_2", {{0.42f, 0.45f, 0.47f}, 0.22f}, 768), 2.4, 2.4}};
    palette_.ceiling = {add("ceiling_panels", panels, 0.9f,
                            [seed = seed_] { return ceiling_texture(seed, "ceiling_panels", 512, 2.4); }),
                        2.4, 2.4};
  }

  void add_doors() {
    const std::array<Paint, 4> leaves = {
        Paint{{0.62f, 0.45f, 0.3f}, 0.45f}, Paint{{0.3f, 0.42f, 0.58f}, 0.35f},
        Paint{{0.74f, 0.73f, 0.7f}, 0.6f}, Paint{{0.16f, 0.16f, 0.17f}, 0.05f}};
    for (int i = 0; i < 8; ++i) {
      const std::string name = "door_" + std::to_string(i + 1);
      const Paint& paint = leaves[static_cast<size_t>(i) % leaves.size()];
      palette_.doors.push_back(add(name, paint, 0.5f, [=, color = paint.srgb, seed = seed_] {
        return door_texture(seed, name, color, 101 + 7 * i);
      }));
    }
    palette_.door_frame = add("door_frame", {{0.42f, 0.43f, 0.45f}, 0.4f}, 0.5f);
    palette_.glass = add("glass", {{0.2f, 0.24f, 0.26f}, 0.05f}, 0.05f);
    builder_.at(palette_.glass).glass = true;
  }

  void add_signs() {
    for (int i = 1; i <= 8; ++i) {
      const std::string name = "poster_" + std::to_string(i);
      palette_.posters.push_back(add(name, {{0.8f, 0.78f, 0.74f}, 0.6f}, 0.4f,
                                     [=, seed = seed_] { return poster_texture(seed, name); }));
    }
    palette_.extinguisher_sign =
        add("extinguisher_sign", {{0.78f, 0.06f, 0.05f}, 0.6f}, 0.3f,
            [seed = seed_] { return extinguisher_texture(seed, "extinguisher_sign"); });
    palette_.exit_sign = add("exit_sign", {{0.04f, 0.5f, 0.22f}, 0.6f}, 0.3f,
                             [seed = seed_] { return exit_texture(seed, "exit_sign"); });
    for (const int sign : {palette_.extinguisher_sign, palette_.exit_sign})
      builder_.at(sign).retro_reflective = true;
    palette_.lamp = add("lamp", {{0.95f, 0.95f, 0.94f}, 0.7f}, 0.3f);
    builder_.at(palette_.lamp).emissive = kLampLuminance_cdpm2 * kLampColor;
    palette_.emergency_lamp = add("emergency", {{0.93f, 0.95f, 0.93f}, 0.7f}, 0.3f);
    builder_.at(palette_.emergency_lamp).emissive = kEmergencyLuminance_cdpm2 * kEmergencyColor;
  }

  int add_stuff_material(const std::string& name, const Paint& paint, double cell_x_m, double cell_y_m,
                         float contrast) {
    return add(name, paint, 0.7f, [=, seed = seed_] {
      return stuff_texture(seed, name, paint.srgb, cell_x_m, cell_y_m, contrast);
    });
  }

  void add_stuff() {
    palette_.wood = add_stuff_material("wood", {{0.62f, 0.47f, 0.32f}, 0.5f}, 0.03, 0.5, 0.2f);
    palette_.metal = add_stuff_material("metal", {{0.6f, 0.61f, 0.63f}, 0.35f}, 0.2, 0.2, 0.06f);
    palette_.cardboard = add_stuff_material("cardboard", {{0.7f, 0.57f, 0.42f}, 0.55f}, 0.3, 0.03, 0.1f);
    palette_.foliage = add_stuff_material("foliage", {{0.25f, 0.48f, 0.2f}, 0.6f}, 0.06, 0.06, 0.6f);
    palette_.pot = add_stuff_material("pot", {{0.62f, 0.36f, 0.26f}, 0.4f}, 0.1, 0.1, 0.15f);
    palette_.fabric = add_stuff_material("fabric", {{0.26f, 0.3f, 0.5f}, 0.35f}, 0.02, 0.02, 0.25f);
  }

  uint64_t seed_;
  double wall_height_m_;
  PaletteBuilder builder_;
  IndoorPalette palette_;
};

}  // namespace

// Luminance times area is the intensity straight down. Off that axis a spot of 90 degrees falls as the square
// of the cosine: a panel with a louvre.
Light ceiling_lamp(const std::string& group, size_t number, const Vec3& panel_world, double area_m2) {
  const bool emergency = group == "emergency";
  Light light{.name = group + "_" + std::to_string(number), .kind = Light::Kind::spot, .group = group};
  light.position_world = panel_world - Vec3(0, 0, 0.05);
  light.color = emergency ? kEmergencyColor : kLampColor;
  light.intensity = (emergency ? kEmergencyLuminance_cdpm2 : kLampLuminance_cdpm2) * area_m2;
  light.radius_m = std::sqrt(area_m2 / std::numbers::pi);
  light.outer_cone_rad = std::numbers::pi / 2;
  return light;
}

IndoorPalette make_indoor_palette(uint64_t seed, double wall_height_m, bool textures) {
  return IndoorPaletteBuilder(seed, wall_height_m, textures).build();
}

}  // namespace vsslam

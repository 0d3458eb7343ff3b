#include "worlds/indoor_palette.h"

#include <array>
#include <string>

namespace vsslam {

namespace {

class PaletteBuilder {
 public:
  PaletteBuilder(uint64_t seed, bool textures) : seed_(seed), textures_(textures) {}

  int add(const std::string& name, const Vec3f& color, float lidar_albedo, float roughness = 0.9f) {
    palette_.materials.push_back(
        {.name = name, .base_color = color, .roughness = roughness, .lidar_albedo = lidar_albedo});
    return static_cast<int>(palette_.materials.size()) - 1;
  }
  Material& at(int index) { return palette_.materials[static_cast<size_t>(index)]; }
  IndoorPalette& palette() { return palette_; }

  [[maybe_unused]] uint64_t seed_;
  [[maybe_unused]] bool textures_;

 private:
  IndoorPalette palette_;
};

}  // namespace

IndoorPalette make_indoor_palette(uint64_t seed, double wall_height_m, bool textures) {
  PaletteBuilder b(seed, textures);
  IndoorPalette& p = b.palette();
  for (int i = 0; i < 4; ++i)
    p.corridor_walls.push_back(
        {b.add("wall_" + std::to_string(i + 1), {0.72f, 0.7f, 0.64f}, 0.7f), 4.0, wall_height_m});
  const std::array<Vec3f, 3> paints = {Vec3f(0.75f, 0.62f, 0.42f), Vec3f(0.45f, 0.58f, 0.68f),
                                       Vec3f(0.52f, 0.62f, 0.45f)};
  for (size_t i = 0; i < paints.size(); ++i)
    p.room_walls.push_back(
        {b.add("room_wall_" + std::to_string(i + 1), paints[i], 0.65f), 4.0, wall_height_m});
  p.corridor_floor = {b.add("floor_tiles", {0.28f, 0.27f, 0.26f}, 0.25f, 0.6f), 2.4, 2.4};
  p.room_floors = {{b.add("room_floor_1", {0.3f, 0.22f, 0.16f}, 0.3f, 0.6f), 2.4, 2.4},
                   {b.add("room_floor_2", {0.2f, 0.24f, 0.26f}, 0.22f, 0.6f), 2.4, 2.4}};
  p.ceiling = {b.add("ceiling_panels", {0.8f, 0.8f, 0.78f}, 0.8f), 2.4, 2.4};
  p.pillar = {b.add("pillar", {0.6f, 0.58f, 0.55f}, 0.5f), 1.2, 3.0};
  const std::array<Vec3f, 4> leaves = {Vec3f(0.42f, 0.26f, 0.13f), Vec3f(0.15f, 0.25f, 0.42f),
                                       Vec3f(0.55f, 0.55f, 0.52f), Vec3f(0.03f, 0.03f, 0.035f)};
  const std::array<float, 4> door_albedo = {0.45f, 0.35f, 0.6f, 0.05f};
  for (size_t i = 0; i < leaves.size(); ++i)
    p.doors.push_back(b.add("door_" + std::to_string(i + 1), leaves[i], door_albedo[i], 0.5f));
  for (int i = 0; i < 6; ++i)
    p.posters.push_back(b.add("poster_" + std::to_string(i + 1), {0.6f, 0.5f, 0.4f}, 0.6f, 0.4f));
  p.door_frame = b.add("door_frame", {0.35f, 0.36f, 0.38f}, 0.4f, 0.5f);
  p.glass = b.add("glass", {0.06f, 0.08f, 0.09f}, 0.05f, 0.05f);
  b.at(p.glass).glass = true;
  p.extinguisher_sign = b.add("extinguisher_sign", {0.7f, 0.05f, 0.04f}, 0.6f, 0.3f);
  p.exit_sign = b.add("exit_sign", {0.05f, 0.5f, 0.2f}, 0.6f, 0.3f);
  for (const int sign : {p.extinguisher_sign, p.exit_sign}) b.at(sign).retro_reflective = true;
  p.lamp = b.add("lamp", {0.9f, 0.9f, 0.88f}, 0.7f, 0.3f);
  b.at(p.lamp).emissive = {1.0f, 0.97f, 0.9f};
  p.emergency_lamp = b.add("emergency", {0.85f, 0.9f, 0.85f}, 0.7f, 0.3f);
  b.at(p.emergency_lamp).emissive = {0.5f, 0.7f, 0.5f};
  p.wood = b.add("wood", {0.45f, 0.3f, 0.17f}, 0.5f, 0.6f);
  p.metal = b.add("metal", {0.4f, 0.41f, 0.43f}, 0.35f, 0.4f);
  p.cardboard = b.add("cardboard", {0.5f, 0.36f, 0.22f}, 0.55f);
  p.foliage = b.add("foliage", {0.1f, 0.26f, 0.07f}, 0.6f);
  p.pot = b.add("pot", {0.45f, 0.2f, 0.12f}, 0.4f);
  p.fabric = b.add("fabric", {0.12f, 0.15f, 0.3f}, 0.35f);
  return std::move(p);
}

}  // namespace vsslam

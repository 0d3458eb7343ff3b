#include "worlds/kit/palette.h"

#include <cmath>
#include <utility>

#include "core/ordered_parallel.h"

namespace vsslam {

namespace {

Vec3f linear(const Vec3f& srgb) {
  return srgb.unaryExpr(
      [](float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); });
}

}  // namespace

int PaletteBuilder::add(const std::string& name, const Paint& paint, float roughness, Painter painter) {
  Material m{.name = name,
             .base_color = linear(paint.srgb),
             .roughness = roughness,
             .lidar_albedo = paint.lidar_albedo};
  if (textures_ && painter) {
    m.base_color = Vec3f::Ones();
    m.base_color_texture = static_cast<int>(painters_.size());
    painters_.push_back(std::move(painter));
  }
  palette_.materials.push_back(std::move(m));
  return static_cast<int>(palette_.materials.size()) - 1;
}

Palette PaletteBuilder::finish() {
  palette_.textures.resize(painters_.size());
  parallel_pieces(painters_.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) palette_.textures[i] = painters_[i]();
  });
  painters_.clear();
  return std::exchange(palette_, {});
}

void adopt_palette(World& world, Palette palette) {
  std::vector<int> new_material(palette.materials.size(), -1), new_texture(palette.textures.size(), -1);
  for (Mesh& mesh : world.meshes)
    for (Primitive& primitive : mesh.primitives) new_material[static_cast<size_t>(primitive.material)] = 0;
  for (size_t m = 0; m < palette.materials.size(); ++m) {
    if (new_material[m] < 0) continue;
    new_material[m] = static_cast<int>(world.materials.size());
    int& texture = palette.materials[m].base_color_texture;
    if (texture >= 0) {
      int& kept = new_texture[static_cast<size_t>(texture)];
      if (kept < 0) {
        kept = static_cast<int>(world.textures.size());
        world.textures.push_back(std::move(palette.textures[static_cast<size_t>(texture)]));
      }
      texture = kept;
    }
    world.materials.push_back(std::move(palette.materials[m]));
  }
  for (Mesh& mesh : world.meshes)
    for (Primitive& primitive : mesh.primitives)
      primitive.material = new_material[static_cast<size_t>(primitive.material)];
}

}  // namespace vsslam

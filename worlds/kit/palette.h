// Materials and textures of a generated world, gathered by name.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "worlds/world.h"

namespace vsslam {

struct Palette {
  std::vector<Texture> textures;
  std::vector<Material> materials;
};

/// How a plain material looks to the camera and to the LiDAR.
struct Paint {
  Vec3f srgb;
  float lidar_albedo;
};

class PaletteBuilder {
 public:
  using Painter = std::function<Texture()>;

  /// Without textures the materials are plain: enough for the LiDAR, and cheaper.
  explicit PaletteBuilder(bool textures) : textures_(textures) {}

  /// Returns the material's index. `paint` is its colour without texture, and what the texture is painted in.
  int add(const std::string& name, const Paint& paint, float roughness, Painter painter = {});
  Material& at(int index) { return palette_.materials[static_cast<size_t>(index)]; }

  /// Paints all textures, on all cores. The builder is empty afterwards.
  Palette finish();

 private:
  bool textures_;
  std::vector<Painter> painters_;
  Palette palette_;
};

/// Takes over materials and textures, and drops those that nothing in the world uses.
void adopt_palette(World& world, Palette palette);

}  // namespace vsslam

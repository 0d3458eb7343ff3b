// Filtered look-up of what surfaces reflect: grey mip pyramids of the world's textures.
//
// Grey is a weighted sum of linear RGB, the response of a monochrome sensor without colour filter. Textures
// are decoded from sRGB once; every level of a pyramid keeps the mean of the one below, whatever its size.
#pragma once

#include <cstdint>
#include <vector>

#include "sensors/surface/lanes.h"
#include "worlds/world.h"

namespace vsslam {

/// Weights of linear red, green and blue (judgement; they sum to 1).
inline const Vec3f kGreyWeights{0.30f, 0.45f, 0.25f};
inline float grey(const Vec3f& linear_rgb) {
  return linear_rgb.dot(kGreyWeights);
}

/// The pyramid of one material; without a texture it is a single texel.
struct Pyramid {
  int first_level = 0, levels = 1;
  int width_px = 1, height_px = 1;  ///< of the finest level
};

/// Reflectances 0..1 of all materials.
class GreyTextures {
 public:
  explicit GreyTextures(const World& world);

  const Pyramid& of_material(int material) const { return pyramids_[static_cast<size_t>(material)]; }

  /// A footprint in the texture: the two edges of what a pixel covers, in texels of the finest level.
  struct Footprint {
    lanes::Floats across_x, across_y, down_x, down_y;
  };
  /// Mean reflectance under the footprint about (u, v), which wrap around: linear within a level and, in the middle half
  /// of the way, between two levels; where the footprint is long and thin up to kMaxProbes times along it. Sizes are
  /// those of the finest level.
  lanes::Floats sample(lanes::Ints first_level, lanes::Ints levels, lanes::Floats width_px,
                       lanes::Floats height_px, lanes::Floats u, lanes::Floats v,
                       const Footprint& footprint) const;
  /// The same for one place and a square footprint of so many texels.
  float sample(const Pyramid& pyramid, const Vec2f& uv, float footprint_px) const;

  static constexpr int kMaxProbes = 6;

 private:
  struct Level {
    int32_t offset;  ///< of texel (-1, -1): a border of one texel wraps around
    int32_t stride;
    float width_px, height_px;
  };
  /// Levels of eight rays.
  struct LevelLanes;
  LevelLanes at(lanes::Ints level) const;
  lanes::Floats bilinear(const LevelLanes& level, lanes::Floats u, lanes::Floats v) const;
  /// Mean of so many probes, evenly along a line of the given length and middle.
  lanes::Floats along(const LevelLanes& level, lanes::Floats u, lanes::Floats v, lanes::Floats length_u,
                      lanes::Floats length_v, lanes::Floats probes) const;

  std::vector<Pyramid> pyramids_;  ///< by material
  std::vector<Level> levels_;
  std::vector<uint32_t> texels_;  ///< each with the one below it in the high half; 0..65535: reflectance 0..1
};

}  // namespace vsslam

// The pictures on outdoor surfaces. Each depends on its name and the seed only, and repeats.
#pragma once

#include <cstdint>
#include <string>

#include "worlds/world.h"

namespace vsslam {

/// Grit, repaired patches, cracks and oil.
Texture asphalt_texture(uint64_t seed, const std::string& name, int size_px, double size_m);
/// Mown grass with blades, worn spots and clover.
Texture lawn_texture(uint64_t seed, const std::string& name, int size_px, double size_m);
/// Bricks of 24 x 7 cm in stretcher bond.
Texture brick_texture(uint64_t seed, const std::string& name, const Vec3f& color, int size_px, double size_m);
/// Render with streaks of rain, stains and hairline cracks.
Texture plaster_texture(uint64_t seed, const std::string& name, const Vec3f& color, int size_px,
                        double size_m);
/// Panels of exposed concrete with joints and anchor holes.
Texture concrete_texture(uint64_t seed, const std::string& name, int size_px, double size_m);
/// One window: frame, bars, curtains or blinds, what the panes mirror. Width : height as 1.2 : 1.5.
Texture window_texture(uint64_t seed, const std::string& name);
/// Leaves beside leaves, light and dark.
Texture leaves_texture(uint64_t seed, const std::string& name, const Vec3f& color);

}  // namespace vsslam

// The pictures on indoor surfaces. Each depends on its name and the seed only.
#pragma once

#include <cstdint>
#include <string>

#include "worlds/world.h"

namespace vsslam {

/// A painted wall, floor at the bottom: skirting, a darker dado with a stripe, scuffs, sockets, a cable duct.
/// Variants of one paint (same colour, other name) join seamlessly side by side.
Texture wall_texture(uint64_t seed, const std::string& name, const Vec3f& paint, int width_px, double width_m,
                     double height_m);
/// 4 x 4 tiles with joints, flecks and stains.
Texture tiles_texture(uint64_t seed, const std::string& name, const Vec3f& color, int size_px, double size_m);
Texture parquet_texture(uint64_t seed, const std::string& name, int size_px, double size_m);
/// 4 x 4 perforated panels.
Texture ceiling_texture(uint64_t seed, const std::string& name, int size_px, double size_m);
/// Leaf with frame, handle and number.
Texture door_texture(uint64_t seed, const std::string& name, const Vec3f& color, int number);
Texture poster_texture(uint64_t seed, const std::string& name);
Texture extinguisher_texture(uint64_t seed, const std::string& name);
Texture exit_texture(uint64_t seed, const std::string& name);
/// A plain material with structure; cells longer along y give it a grain.
Texture stuff_texture(uint64_t seed, const std::string& name, const Vec3f& color, double cell_x_m,
                      double cell_y_m, float contrast);

}  // namespace vsslam

// glTF 2.0 files in and out.
#pragma once

#include <filesystem>

#include "worlds/world.h"

namespace vsslam {

/// Reads a .gltf or .glb. Throws InputError that names the file and the place in its JSON.
World read_gltf(const std::filesystem::path& path);

/// Writes a .glb; reading it gives the same world.
void write_glb(const World& world, const std::filesystem::path& path);

}  // namespace vsslam

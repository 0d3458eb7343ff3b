// Clouds as PLY files.
#pragma once

#include <filesystem>

#include "slam/lidar/cloud.h"

namespace vsslam {

/// Binary little-endian PLY with float x, y, z. Throws ResourceError.
void write_ply(const std::filesystem::path& path, const Cloud& cloud);

}  // namespace vsslam

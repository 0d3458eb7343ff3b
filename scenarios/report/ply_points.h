// Points of a PLY file.
#pragma once

#include <filesystem>

#include "slam/lidar/cloud.h"

namespace vsslam {

/// x y z (float or double) of element `vertex`, ascii or binary_little_endian, other properties skipped; the
/// vertices must be the file's first element. Throws InputError that names the file and says what is wrong.
Cloud read_ply_points(const std::filesystem::path& path);

}  // namespace vsslam

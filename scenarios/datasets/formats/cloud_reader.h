// Files of one cloud each, as messages.
#pragma once

#include <filesystem>

#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// KITTI's velodyne/*.bin: x y z reflectance float32. Reflectances of 0..1 become 0..255. Throws InputError.
PointCloudMessage read_kitti_cloud(const std::filesystem::path& path);

/// Binary, uncompressed PCD with any fields. Throws InputError that names the file.
PointCloudMessage read_pcd_cloud(const std::filesystem::path& path);

}  // namespace vsslam

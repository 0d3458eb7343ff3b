// The map as one cloud.
#pragma once

#include <vector>

#include "slam/map/key_scan.h"

namespace vsslam {

/// Points of all key scans at their corrected poses, at most one (the first) per cube of `voxel_m`.
Cloud map_cloud(const std::vector<KeyScan>& keys, const SE3& T_base_lidar, double voxel_m);

/// At most one point (the first) per cube of `voxel_m`, order kept.
Cloud thin_cloud(const Cloud& cloud, double voxel_m);

}  // namespace vsslam

#include "slam/map/map_cloud.h"

#include "slam/lidar/voxel_hash.h"

namespace vsslam {

Cloud map_cloud(const std::vector<KeyScan>& keys, const SE3& T_base_lidar, double voxel_m) {
  const auto inverse = static_cast<float>(1.0 / voxel_m);
  KeyIndex seen(1 << 16);
  Cloud map;
  for (const KeyScan& key : keys) {
    const SE3 T_map_lidar = key.T_map_base * T_base_lidar;
    const Eigen::Matrix3f R = T_map_lidar.matrix3().cast<float>();
    const Eigen::Vector3f t = T_map_lidar.translation.cast<float>();
    for (const Eigen::Vector3f& point_lidar : *key.map_points_lidar) {
      const Eigen::Vector3f point_map = R * point_lidar + t;
      const size_t before = seen.size();
      seen.insert(voxel_key(point_map, inverse));
      if (seen.size() > before) map.push_back(point_map);
    }
  }
  return map;
}

Cloud thin_cloud(const Cloud& cloud, double voxel_m) {
  const auto inverse = static_cast<float>(1.0 / voxel_m);
  KeyIndex seen(cloud.size() / 4);
  Cloud kept;
  for (const Eigen::Vector3f& point : cloud) {
    const size_t before = seen.size();
    seen.insert(voxel_key(point, inverse));
    if (seen.size() > before) kept.push_back(point);
  }
  return kept;
}

}  // namespace vsslam

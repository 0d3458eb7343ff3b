#include "slam/loop/virtual_descriptors.h"

#include <cmath>
#include <numbers>

#include "slam/lidar/voxel_hash.h"

namespace vsslam {

namespace {

constexpr int kDirections = 8;

/// The highest point of each column: only these can be the highest of a cell of any descriptor.
Cloud highest_points(const Cloud& cloud) {
  constexpr float kColumnsPerM = 10;
  KeyIndex columns(cloud.size() / 8);
  Cloud highest;
  for (const Eigen::Vector3f& point : cloud) {
    const auto at = static_cast<size_t>(columns.insert(voxel_key({point.x(), point.y(), 0}, kColumnsPerM)));
    if (at == highest.size()) {
      highest.push_back(point);
    } else if (point.z() > highest[at].z()) {
      highest[at] = point;
    }
  }
  return highest;
}

}  // namespace

std::vector<Eigen::Vector2d> virtual_offsets_m(const VirtualDescriptorConfig& config) {
  std::vector<Eigen::Vector2d> offsets_m;
  for (int i = 1; i <= config.distances; ++i)
    for (int j = 0; j < kDirections; ++j) {
      const double theta = 2 * std::numbers::pi * j / kDirections, far_m = config.spacing_m * i;
      // T_virtual moves the cloud by + M i (sin, cos), that is the sensor by the opposite.
      offsets_m.emplace_back(-far_m * std::sin(theta), -far_m * std::cos(theta));
    }
  return offsets_m;
}

std::vector<QueryDescriptor> describe_query(const Cloud& points_lidar, double mount_height_m,
                                            const ScanContextConfig& scan_context,
                                            const VirtualDescriptorConfig& config) {
  std::vector<QueryDescriptor> query;
  query.push_back({ScanContext(polar_heights(points_lidar, mount_height_m, scan_context)), 0, {0, 0}});
  const std::vector<Eigen::Vector2d> offsets_m = virtual_offsets_m(config);
  if (offsets_m.empty()) return query;
  const Cloud highest_lidar = highest_points(points_lidar);
  for (const Eigen::Vector2d& offset_m : offsets_m)
    query.push_back({ScanContext(polar_heights(highest_lidar, mount_height_m, scan_context, offset_m)),
                     static_cast<int>(query.size()), offset_m});
  return query;
}

}  // namespace vsslam

#include "scenarios/results/map_file.h"

#include <fmt/format.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "core/errors.h"

namespace vsslam {

void write_ply(const std::filesystem::path& path, const Cloud& cloud) {
  pcl::PointCloud<pcl::PointXYZ> points;
  points.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud) points.emplace_back(p.x(), p.y(), p.z());
  constexpr bool kBinary = true, kCameraElement = false;
  if (pcl::PLYWriter().write(path.string(), points, kBinary, kCameraElement) != 0)
    throw ResourceError(fmt::format("{}: cannot write", path.string()));
}

}  // namespace vsslam

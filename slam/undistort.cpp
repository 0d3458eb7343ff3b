#include "slam/undistort.h"

#include <algorithm>

namespace vsslam {

namespace {

using Affine = Eigen::Matrix<float, 3, 4>;  // [R | t]

// Poses of the sensor on a uniform grid of about 2 ms. Between two of them the matrix is blended linearly: at
// 3 rad/s its error is (0.006)^2 / 8 = 5e-6.
struct PoseGrid {
  float step_s = 1.0f;
  std::vector<Affine> T_begin_lidar;

  PoseGrid(const LidarScan& scan, const MotionPath& path, const SE3& T_base_lidar) {
    const int64_t span_ns = std::max<int64_t>((scan.end - scan.stamp).ns, 1);
    const int64_t steps = std::clamp<int64_t>(span_ns / 2'000'000, 1, 1000);
    step_s = static_cast<float>(1e-9 * static_cast<double>(span_ns) / static_cast<double>(steps));
    const SE3 T_lidar_base = T_base_lidar.inverse();
    for (int64_t i = 0; i <= steps; ++i) {
      const SE3 T = T_lidar_base * path.at(scan.stamp + Duration{span_ns * i / steps}) * T_base_lidar;
      T_begin_lidar.emplace_back();
      T_begin_lidar.back() << T.matrix3().cast<float>(), T.translation.cast<float>();
    }
  }

  Eigen::Vector3f to_begin(const LidarPoint& p) const {
    const float position = std::max(p.time_s / step_s, 0.0f);
    const size_t i = std::min(static_cast<size_t>(position), T_begin_lidar.size() - 2);
    const float u = position - static_cast<float>(i);
    const Affine T = T_begin_lidar[i] + u * (T_begin_lidar[i + 1] - T_begin_lidar[i]);
    return T * Eigen::Vector4f(p.x, p.y, p.z, 1.0f);
  }
};

}  // namespace

Cloud undistort(const LidarScan& scan, const MotionPath& path, const SE3& T_base_lidar) {
  const PoseGrid grid(scan, path, T_base_lidar);
  Cloud points_lidar;
  points_lidar.reserve(scan.points.size());
  for (const LidarPoint& p : scan.points) points_lidar.push_back(grid.to_begin(p));
  return points_lidar;
}

}  // namespace vsslam

#include "sensors/camera/camera_flow.h"

#include <algorithm>
#include <limits>

namespace vsslam {

std::vector<Vec2f> flow(const CameraOptics& optics, const ViewRays& rays, const std::vector<float>& depth_m,
                        const SE3& T_b_a) {
  const Vec2f behind = Vec2f::Constant(std::numeric_limits<float>::infinity());
  const Mat3 R_b_a = T_b_a.matrix3();
  std::vector<Vec2f> flow_px(depth_m.size(), behind);
  for (size_t i = 0; i < depth_m.size(); ++i) {
    const Vec3f& ray = rays.direction_camera[i];
    if (!(ray.z() > 0)) continue;
    const Vec3 ray_a(static_cast<double>(ray.x() / ray.z()), static_cast<double>(ray.y() / ray.z()), 1);
    // The point over its depth, so that infinity needs no case of its own.
    const double inverse_depth = 1 / static_cast<double>(depth_m[i]);
    const Vec3 ray_b = R_b_a * ray_a + inverse_depth * T_b_a.translation;
    if (!(ray_b.z() > 0)) continue;
    flow_px[i] = optics.difference(ray_b.head<2>() * (1 / ray_b.z()), ray_a.head<2>()).cast<float>();
  }
  return flow_px;
}

double length_of_most(const std::vector<Vec2f>& flow_px) {
  std::vector<float> lengths;
  for (const Vec2f& f : flow_px) lengths.push_back(f.norm());
  const auto at = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 95 / 100);
  std::nth_element(lengths.begin(), at, lengths.end());
  return static_cast<double>(*at);
}

}  // namespace vsslam

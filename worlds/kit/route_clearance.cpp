#include "worlds/kit/route_clearance.h"

#include <algorithm>
#include <limits>

namespace vsslam {

RouteClearance::RouteClearance(const std::vector<Route>& routes) {
  for (const Route& route : routes)
    for (size_t i = 0; i < route.points_world.size(); ++i) {
      if (i + 1 == route.points_world.size() && !route.closed) continue;
      const Vec3& a = route.points_world[i];
      const Vec3& b = route.points_world[(i + 1) % route.points_world.size()];
      const int steps = static_cast<int>((b - a).norm() / 0.1) + 1;
      for (int k = 0; k <= steps; ++k) path_.push_back((a + (b - a) * k / steps).head<2>());
    }
}

double RouteClearance::distance_m(const Rect& r) const {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p : path_) {
    const Eigen::Vector2d nearest(std::clamp(p.x(), r.x0, r.x1), std::clamp(p.y(), r.y0, r.y1));
    nearest2 = std::min(nearest2, (p - nearest).squaredNorm());
  }
  return std::sqrt(nearest2);
}

}  // namespace vsslam

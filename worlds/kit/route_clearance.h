// Keeps what is placed in a world off the routes.
#pragma once

#include <vector>

#include "worlds/kit/floor_plan.h"
#include "worlds/world.h"

namespace vsslam {

class RouteClearance {
 public:
  explicit RouteClearance(const std::vector<Route>& routes);
  /// Horizontal distance of a rectangle to the nearest route; infinity without routes.
  double distance_m(const Rect& rect) const;

 private:
  std::vector<Eigen::Vector2d> path_;  ///< of all routes, every 10 cm
};

}  // namespace vsslam

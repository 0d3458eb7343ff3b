// A route of the world as a line in the plane with a direction of travel.
#pragma once

#include <string>
#include <vector>

#include "sim/drive_script.h"
#include "sim/path.h"
#include "worlds/world.h"

namespace vsslam {

class RouteLine {
 public:
  /// `place` stands for the key in messages. Throws InputError: no such route, too short, not finite, or not closed
  /// where the direction needs it.
  RouteLine(const World& world, const std::string& name, RouteDirection direction, const std::string& place);

  double length_m() const { return length_m_; }
  bool closed() const { return closed_; }
  /// Position and direction of travel at an arc length.
  PlanarPose at(double s_m, const std::string& place) const;
  /// The corners from `start_s_m` over `laps` of the whole length; what goes round more than once is repeated.
  std::vector<Vec2> stretch(double start_s_m, double laps, const std::string& place) const;

 private:
  void orient(RouteDirection direction, const std::string& place);

  std::string name_;
  bool closed_ = false;
  std::vector<Vec2> points_;  // a closed line ends with its first point
  double length_m_ = 0;
};

}  // namespace vsslam

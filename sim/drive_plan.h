// A drive script worked out against a world: every path, turn and rest in order, before the robot moves.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "sim/drive_script.h"
#include "sim/path.h"
#include "sim/scout.h"
#include "worlds/world.h"

namespace vsslam {

struct PlannedRest {
  double duration_s = 0;
};

struct PlannedTurn {
  double from_rad = 0;   ///< planned yaw at its begin
  double angle_rad = 0;  ///< positive: counterclockwise
  double rate_radps = 0.5;
};

struct PlannedFollow {
  Path path;
  std::string name;  ///< of the route, or "waypoints"
};

using PlannedStep = std::variant<PlannedRest, PlannedTurn, PlannedFollow>;

struct DrivePlan {
  PlanarPose start;
  std::vector<PlannedStep> steps;

  double duration_s(const ScoutConfig& scout) const;
};

/// Throws InputError: unknown route, an open route that should be closed, too fast, no way to go.
DrivePlan plan_drive(const DriveScript& script, const World& world, const ScoutConfig& scout);

}  // namespace vsslam

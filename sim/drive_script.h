// The `drive` section of a scenario: where the robot starts and what it does, step by step.
//
//   drive:
//     start: {route: ring, s_m: 3.0}   # or {x_m: 1, y_m: 2, yaw_deg: 90}; default: where the first path begins
//     steps:
//       - rest: {duration_s: 3}
//       - follow: {route: ring, laps: 1.1, direction: counterclockwise, last_lap_offset_m: 0.4}
//       - turn: {angle_deg: -90, rate_radps: 0.5}
//       - follow: {waypoints: [{x_m: 3, y_m: 0}, {x_m: 3, y_m: 8}]}
//       - loop: {times: 2, steps: [{turn: {angle_deg: 180}}, {rest: {duration_s: 1}}]}
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/config.h"

namespace vsslam {

/// Stand still.
struct RestStep {
  double duration_s = 1.0;
  void fields(Fields& f);
};

/// A corner of a path, in the world frame.
struct Waypoint {
  double x_m = 0, y_m = 0;
  void fields(Fields& f);
};

/// Which way round a route. The clockwise senses are seen from above and need a closed route.
enum class RouteDirection { forward, reverse, counterclockwise, clockwise };

/// Drive along a route of the world, or along waypoints of one's own (exactly one of the two). Corners are
/// rounded, turns sharper than 100 deg are made in place. Where the path does not begin at the robot, the
/// robot drives to its beginning in a straight line first.
struct FollowStep {
  std::string route;  ///< name of one of World::routes
  std::vector<Waypoint> waypoints;
  double speed_mps = 1.0;
  double laps = 1.0;  ///< may be a fraction; more than 1 needs a closed route
  RouteDirection direction = RouteDirection::forward;
  double start_s_m = 0.0;         ///< where on the route to begin, along the direction of travel
  double lateral_offset_m = 0.0;  ///< of the driven path, positive to the left of travel
  std::optional<double>
      last_lap_offset_m;        ///< replaces lateral_offset_m from the start of the last lap begun:
                                ///< with laps 1.1, on the tenth that overlaps the beginning
  double offset_blend_m = 6.0;  ///< length before that over which the offset changes
  void fields(Fields& f);
};

/// Turn in place.
struct TurnStep {
  double angle_deg = 90.0;  ///< positive: counterclockwise
  double rate_radps = 0.5;
  void fields(Fields& f);
};

struct DriveStep;

/// Repeat steps.
struct LoopStep {
  int times = 2;
  std::vector<DriveStep> steps;
  void fields(Fields& f);
};

/// Exactly one of these.
struct DriveStep {
  std::optional<RestStep> rest;
  std::optional<FollowStep> follow;
  std::optional<TurnStep> turn;
  std::optional<LoopStep> loop;
  void fields(Fields& f);
};

/// Where the robot stands at time 0: beside a route, heading along it, or at x, y.
struct DriveStart {
  std::string route;  ///< empty: x_m and y_m count
  double s_m = 0, lateral_offset_m = 0;
  double x_m = 0, y_m = 0;
  double yaw_deg = 0;  ///< with a route: added to the route's heading
  void fields(Fields& f);
};

struct DriveScript {
  std::optional<DriveStart> start;  ///< default: the beginning of the first path, heading along it
  std::vector<DriveStep> steps;
  void fields(Fields& f);
};

}  // namespace vsslam

#include "sim/drive_script.h"

namespace vsslam {

void RestStep::fields(Fields& f) {
  f("duration_s", duration_s, between(0, 1e5));
}

void Waypoint::fields(Fields& f) {
  f("x_m", x_m, between(-1e5, 1e5));
  f("y_m", y_m, between(-1e5, 1e5));
}

void FollowStep::fields(Fields& f) {
  f("route", route);
  f("waypoints", waypoints);
  f("speed_mps", speed_mps, between(0.02, 5));
  f("laps", laps, between(0.001, 1000));
  f.choice("direction", direction,
           {{"forward", RouteDirection::forward},
            {"reverse", RouteDirection::reverse},
            {"counterclockwise", RouteDirection::counterclockwise},
            {"clockwise", RouteDirection::clockwise}});
  f("start_s_m", start_s_m, non_negative());
  f("lateral_offset_m", lateral_offset_m, between(-100, 100));
  f("last_lap_offset_m", last_lap_offset_m);
  f("offset_blend_m", offset_blend_m, between(0.5, 1000));
  f.check(route.empty() != waypoints.empty(), "route", "either a route or waypoints");
  f.check(!last_lap_offset_m || laps > 1, "last_lap_offset_m", "more than one lap");
}

void TurnStep::fields(Fields& f) {
  f("angle_deg", angle_deg, between(-3600, 3600));
  f("rate_radps", rate_radps, between(0.02, 3));
}

void LoopStep::fields(Fields& f) {
  f("times", times, between(1, 10000));
  f("steps", steps);
  f.check(!steps.empty(), "steps", "at least one step");
}

void DriveStep::fields(Fields& f) {
  f("rest", rest);
  f("follow", follow);
  f("turn", turn);
  f("loop", loop);
  const int kinds = rest.has_value() + follow.has_value() + turn.has_value() + loop.has_value();
  f.check(kinds == 1, "step", "exactly one of rest, follow, turn, loop");
}

void DriveStart::fields(Fields& f) {
  f("route", route);
  f("s_m", s_m, non_negative());
  f("lateral_offset_m", lateral_offset_m, between(-100, 100));
  f("x_m", x_m, between(-1e5, 1e5));
  f("y_m", y_m, between(-1e5, 1e5));
  f("yaw_deg", yaw_deg, between(-360, 360));
}

void DriveScript::fields(Fields& f) {
  f("start", start);
  f("steps", steps);
}

}  // namespace vsslam

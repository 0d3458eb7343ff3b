#include "sim/drive_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "sim/route_line.h"

namespace vsslam {

namespace {

constexpr double kRadPerDeg = M_PI / 180;
constexpr double kSharp_rad = 100 * kRadPerDeg;  // turned in place
constexpr double kShortest_m = 0.2;
constexpr double kFar_m = 1.0;  // from a path's beginning: it is approached in a straight line
constexpr size_t kMostSteps = 100'000;

// Smooth from 0 to 1 with vanishing first and second derivatives at both ends.
double smooth_step(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 + u * (6 * u - 15));
}

class Planner {
 public:
  Planner(const World& world, const ScoutConfig& scout) : world_(world), scout_(scout) {}

  DrivePlan plan(const DriveScript& script) {
    if (script.steps.empty()) throw InputError("drive.steps: expected at least one step");
    plan_.start = here_ =
        script.start ? start_pose(*script.start) : default_start(script.steps, "drive.steps");
    add_steps(script.steps, "drive.steps");
    return std::move(plan_);
  }

 private:
  PlanarPose start_pose(const DriveStart& start) const {
    if (start.route.empty()) return {{start.x_m, start.y_m}, wrap_angle(start.yaw_deg * kRadPerDeg)};
    const RouteLine line(world_, start.route, RouteDirection::forward, "drive.start.route");
    const PlanarPose on_line = line.at(start.s_m, "drive.start.s_m");
    const Vec2 left(-std::sin(on_line.yaw_rad), std::cos(on_line.yaw_rad));
    return {on_line.position_m + start.lateral_offset_m * left,
            wrap_angle(on_line.yaw_rad + start.yaw_deg * kRadPerDeg)};
  }

  // Where the first path begins.
  PlanarPose default_start(const std::vector<DriveStep>& steps, const std::string& place) const {
    for (size_t i = 0; i < steps.size(); ++i) {
      const std::string here = fmt::format("{}[{}]", place, i);
      if (steps[i].loop) return default_start(steps[i].loop->steps, here + ".loop.steps");
      if (steps[i].follow)
        return follow_path(*steps[i].follow, here + ".follow", std::nullopt).front().begin();
    }
    return {};
  }

  void add_steps(const std::vector<DriveStep>& steps, const std::string& place) {
    for (size_t i = 0; i < steps.size(); ++i) add_step(steps[i], fmt::format("{}[{}]", place, i));
  }

  void add_step(const DriveStep& step, const std::string& place) {
    if (plan_.steps.size() > kMostSteps)
      throw InputError(fmt::format("{}: more than {} steps", place, kMostSteps));
    if (step.rest) {
      plan_.steps.emplace_back(PlannedRest{step.rest->duration_s});
    } else if (step.turn) {
      add_turn(*step.turn, place + ".turn");
    } else if (step.follow) {
      add_follow(*step.follow, place + ".follow");
    } else if (step.loop) {
      for (int k = 0; k < step.loop->times; ++k) add_steps(step.loop->steps, place + ".loop.steps");
    } else {
      throw InputError(fmt::format("{}: expected one of rest, follow, turn, loop", place));
    }
  }

  void add_turn(const TurnStep& turn, const std::string& place) {
    if (turn.rate_radps > scout_.max_yaw_rate_radps)
      throw InputError(fmt::format("{}.rate_radps: {} is more than the robot's limit of {}", place,
                                   turn.rate_radps, scout_.max_yaw_rate_radps));
    turn_by(turn.angle_deg * kRadPerDeg, turn.rate_radps);
  }

  void turn_by(double angle_rad, double rate_radps) {
    plan_.steps.emplace_back(PlannedTurn{here_.yaw_rad, angle_rad, rate_radps});
    here_.yaw_rad = wrap_angle(here_.yaw_rad + angle_rad);
  }

  void add_follow(const FollowStep& follow, const std::string& place) {
    if (follow.speed_mps > scout_.max_speed_mps)
      throw InputError(fmt::format("{}.speed_mps: {} is more than the robot's limit of {}", place,
                                   follow.speed_mps, scout_.max_speed_mps));
    for (Path& path : follow_path(follow, place, here_)) {
      const double turn_rad = wrap_angle(path.begin().yaw_rad - here_.yaw_rad);
      if (std::abs(turn_rad) > 0.25 * M_PI) turn_by(turn_rad, turning_rate());
      here_ = path.end();
      plan_.steps.emplace_back(
          PlannedFollow{std::move(path), follow.route.empty() ? "waypoints" : follow.route});
    }
  }

  double turning_rate() const { return std::min(0.5, scout_.max_yaw_rate_radps); }

  // The smooth pieces of the step, between places that are turned at.
  std::vector<Path> follow_path(const FollowStep& follow, const std::string& place,
                                const std::optional<PlanarPose>& from) const {
    std::vector<Vec2> corners =
        follow.route.empty() ? waypoints(follow, place) : route_corners(follow, place);
    double approach_m = 0;
    std::vector<Vec2> straight_on;
    if (from) {
      const Vec2 begin = driven_begin(corners, follow.lateral_offset_m);
      approach_m = (begin - from->position_m).norm();
      if (approach_m <= (follow.route.empty() ? kShortest_m : kFar_m))
        approach_m = 0;
      else if (follow.lateral_offset_m == 0)
        corners.insert(corners.begin(), from->position_m);
      else
        straight_on = {from->position_m, begin};
    }
    if (corners.size() < 2 || !(polyline_length_m(corners) >= kShortest_m))
      throw InputError(
          fmt::format("{}: there is no way to go: the path is shorter than {} m", place, kShortest_m));
    const SpeedLimits limits{.speed_mps = follow.speed_mps,
                             .yaw_rate_radps = 0.75 * scout_.max_yaw_rate_radps,
                             .accel_mps2 = scout_.accel_mps2};
    std::vector<Path> paths;
    if (!straight_on.empty()) {  // to the line beside the route, which begins there
      const std::vector<Vec2> samples = resample(straight_on);
      paths.emplace_back(samples, std::vector<double>(samples.size(), 0.0), limits);
      approach_m = 0;
    }
    double before_m = -approach_m;  // arc length on the route where the piece begins
    for (const std::vector<Vec2>& piece : split_at_sharp_corners(corners)) {
      const std::vector<Vec2> samples = resample(piece);
      paths.emplace_back(samples, offsets(follow, samples, before_m, lap_m(follow, place)), limits);
      before_m += polyline_length_m(piece);
    }
    return paths;
  }

  static Vec2 driven_begin(const std::vector<Vec2>& corners, double offset_left_m) {
    if (corners.size() < 2) return corners.front();
    const Vec2 along = (corners[1] - corners[0]).normalized();
    return corners.front() + offset_left_m * Vec2(-along.y(), along.x());
  }

  std::vector<Vec2> waypoints(const FollowStep& follow, const std::string& place) const {
    if (follow.waypoints.empty())
      throw InputError(fmt::format("{}: expected a route or a list of waypoints", place));
    if (follow.laps != 1)
      throw InputError(fmt::format("{}.laps: waypoints are driven once; use a loop", place));
    std::vector<Vec2> corners;
    for (const Waypoint& waypoint : follow.waypoints) {
      const Vec2 corner(waypoint.x_m, waypoint.y_m);
      if (!corner.allFinite()) throw InputError(fmt::format("{}.waypoints: expected finite numbers", place));
      if (corners.empty() || (corner - corners.back()).norm() > 1e-6) corners.push_back(corner);
    }
    return corners;
  }

  std::vector<Vec2> route_corners(const FollowStep& follow, const std::string& place) const {
    if (!follow.waypoints.empty())
      throw InputError(fmt::format("{}: expected a route or waypoints, not both", place));
    const RouteLine line(world_, follow.route, follow.direction, place + ".route");
    return line.stretch(follow.start_s_m, follow.laps, place);
  }

  double lap_m(const FollowStep& follow, const std::string& place) const {
    if (follow.route.empty()) return 0;
    return RouteLine(world_, follow.route, follow.direction, place + ".route").length_m();
  }

  static std::vector<double> offsets(const FollowStep& follow, const std::vector<Vec2>& samples,
                                     double before_m, double lap_m) {
    const double last_lap_m = lap_m * (std::ceil(follow.laps) - 1);
    const double last_offset_m = follow.last_lap_offset_m.value_or(follow.lateral_offset_m);
    std::vector<double> out;
    double s_m = before_m;
    for (size_t i = 0; i < samples.size(); ++i) {
      if (i > 0) s_m += (samples[i] - samples[i - 1]).norm();
      const double change = smooth_step(1 + (s_m - last_lap_m) / follow.offset_blend_m);
      out.push_back(follow.lateral_offset_m + change * (last_offset_m - follow.lateral_offset_m));
    }
    return out;
  }

  static std::vector<std::vector<Vec2>> split_at_sharp_corners(const std::vector<Vec2>& corners) {
    std::vector<std::vector<Vec2>> pieces{{corners.front()}};
    for (size_t i = 1; i < corners.size(); ++i) {
      pieces.back().push_back(corners[i]);
      if (i + 1 == corners.size()) break;
      const Vec2 in = corners[i] - corners[i - 1], out = corners[i + 1] - corners[i];
      const double turn_rad = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
      if (std::abs(turn_rad) > kSharp_rad) pieces.push_back({corners[i]});
    }
    return pieces;
  }

  const World& world_;
  const ScoutConfig& scout_;
  DrivePlan plan_;
  PlanarPose here_;  // where the robot will be after the steps so far
};

}  // namespace

DrivePlan plan_drive(const DriveScript& script, const World& world, const ScoutConfig& scout) {
  return Planner(world, scout).plan(script);
}

double DrivePlan::duration_s(const ScoutConfig& scout) const {
  double duration_s = 0;
  for (const PlannedStep& step : steps) {
    if (const auto* rest = std::get_if<PlannedRest>(&step)) duration_s += rest->duration_s;
    if (const auto* follow = std::get_if<PlannedFollow>(&step)) duration_s += follow->path.duration_s();
    if (const auto* turn = std::get_if<PlannedTurn>(&step))
      duration_s += std::abs(turn->angle_rad) / turn->rate_radps + turn->rate_radps / scout.yaw_accel_radps2;
  }
  return duration_s;
}

}  // namespace vsslam

#include "sim/drive_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "tests/sim/small_worlds.h"

namespace vsslam {
namespace {

DriveScript script(const std::string& yaml) {
  DriveScript out;
  load_config_text(yaml, "drive.yaml", out);
  return out;
}
DrivePlan plan(const std::string& yaml) {
  return plan_drive(script(yaml), routes_world(10, 5), {});
}
const Path& path(const DrivePlan& plan, size_t step) {
  return std::get<PlannedFollow>(plan.steps.at(step)).path;
}
std::string error_of(const std::string& yaml) {
  try {
    plan(yaml);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Path, IsSmoothAndLimitsItsSpeed) {
  const std::vector<Vec2> samples = resample({{0, 0}, {5, 0}, {5, 5}});
  const SpeedLimits limits{.speed_mps = 1, .yaw_rate_radps = 0.5, .accel_mps2 = 0.8};
  const Path path(samples, std::vector<double>(samples.size(), 0), limits);
  EXPECT_LT((path.begin().position_m - Vec2(0, 0)).norm(), 1e-12);
  EXPECT_LT((path.end().position_m - Vec2(5, 5)).norm(), 1e-12);
  EXPECT_NEAR(path.end().yaw_rad, M_PI / 2, 1e-6);
  EXPECT_LT((path.at(5).position_m - Vec2(5, 0)).norm(), 0.15);
  double before_mps = 0;
  for (double s = 0.05; s < path.length_m(); s += 0.05) {
    const Path::Place place = path.at(s);
    EXPECT_LE(place.speed_mps, 1);
    EXPECT_LE(place.speed_mps * std::abs(place.curvature_radpm), 1.03 * 0.5);
    EXPECT_LE(std::abs(place.speed_mps * place.speed_mps - before_mps * before_mps), 1.1 * 2 * 0.8 * 0.05);
    EXPECT_NEAR(path.nearest(place.position_m, s - 0.3, s + 0.3), s, 1e-6);
    before_mps = place.speed_mps;
  }
}

TEST(Path, KeepsARoundCornersRadiusAndOffset) {
  std::vector<Vec2> arc;
  for (int deg = 0; deg <= 180; deg += 3)
    arc.emplace_back(2 * std::cos(deg * M_PI / 180), 2 * std::sin(deg * M_PI / 180));
  const std::vector<Vec2> samples = resample(arc);
  const Path path(samples, std::vector<double>(samples.size(), 0.5), {});  // left of travel: inwards
  for (double s = 1; s < path.length_m() - 1; s += 0.1) {
    EXPECT_NEAR(path.at(s).position_m.norm(), 1.5, 0.02);
    EXPECT_NEAR(path.at(s).curvature_radpm, 1 / 1.5, 0.05);
  }
}

TEST(DrivePlan, StartsWhereTheFirstPathBegins) {
  const DrivePlan p = plan("steps: [{rest: {duration_s: 1}}, {follow: {route: ring, start_s_m: 3}}]");
  EXPECT_LT((p.start.position_m - Vec2(10, -2)).norm(), 1e-9);
  EXPECT_NEAR(p.start.yaw_rad, M_PI / 2, 1e-9);
  const DrivePlan left = plan("steps: [{follow: {route: line, lateral_offset_m: 0.4}}]");
  EXPECT_LT((left.start.position_m - Vec2(0, 0.4)).norm(), 1e-9);
}

TEST(DrivePlan, StartsWhereItIsTold) {
  const DrivePlan beside = plan("start: {route: line, s_m: 2, lateral_offset_m: -1}\nsteps: [{rest: {}}]");
  EXPECT_LT((beside.start.position_m - Vec2(2, -1)).norm(), 1e-9);
  const DrivePlan at =
      plan("start: {x_m: 3, y_m: 4, yaw_deg: 90}\nsteps: [{follow: {waypoints: [{x_m: 3, y_m: 9}]}}]");
  EXPECT_EQ(at.start.position_m, Vec2(3, 4));
  EXPECT_NEAR(path(at, 0).length_m(), 5, 1e-9);
}

TEST(DrivePlan, GoesRoundInTheDirectionAsked) {
  EXPECT_NEAR(plan("steps: [{follow: {route: ring, direction: counterclockwise}}]").start.yaw_rad, M_PI / 2,
              1e-9);
  EXPECT_NEAR(plan("steps: [{follow: {route: ring, direction: forward}}]").start.yaw_rad, M_PI / 2, 1e-9);
  const DrivePlan clockwise = plan("steps: [{follow: {route: ring, direction: clockwise}}]");
  EXPECT_NEAR(std::abs(clockwise.start.yaw_rad), M_PI, 1e-9);
  EXPECT_LT((path(clockwise, 0).at(20).position_m - Vec2(-10, -5)).norm(), 0.2);
  EXPECT_NEAR(path(plan("steps: [{follow: {route: line, direction: reverse}}]"), 0).end().position_m.x(), 0,
              1e-9);
}

TEST(DrivePlan, ChangesTheOffsetBeforeTheOverlap) {
  const DrivePlan p =
      plan("steps: [{follow: {route: ring, laps: 1.1, lateral_offset_m: 0.1, last_lap_offset_m: -0.3}}]");
  EXPECT_NEAR(path(p, 0).at(3).position_m.x(), 10 - 0.1, 0.01);
  EXPECT_NEAR(path(p, 0).end().position_m.x(), 10 + 0.3, 1e-6);
  EXPECT_NEAR(path(p, 0).end().position_m.y(), 1, 1e-6);
  EXPECT_NEAR(path(p, 0).length_m(), 66, 1.5);
}

TEST(DrivePlan, TurnsAtSharpCorners) {
  const DrivePlan p =
      plan("steps: [{follow: {waypoints: [{x_m: 0, y_m: 0}, {x_m: 6, y_m: 0}, {x_m: 0, y_m: 0.1}]}}]");
  ASSERT_EQ(p.steps.size(), 3u);
  EXPECT_NEAR(std::abs(std::get<PlannedTurn>(p.steps[1]).angle_rad), M_PI, 0.02);
  EXPECT_LT((path(p, 2).begin().position_m - Vec2(6, 0)).norm(), 1e-12);
}

TEST(DrivePlan, DrivesToAPathThatBeginsElsewhere) {
  const DrivePlan p = plan("start: {x_m: -4, y_m: 0}\nsteps: [{follow: {route: line}}]");
  EXPECT_LT((path(p, 0).begin().position_m - Vec2(-4, 0)).norm(), 1e-12);
  EXPECT_NEAR(path(p, 0).length_m(), 14, 1e-6);
}

TEST(DrivePlan, BeginsOnTheLineBesideTheRoute) {
  const std::string lane = "{follow: {route: line, lateral_offset_m: -1.3}}";
  const DrivePlan once = plan("steps: [" + lane + "]");
  ASSERT_EQ(once.steps.size(), 1u);  // no detour by the route itself
  EXPECT_LT((path(once, 0).begin().position_m - Vec2(0, -1.3)).norm(), 1e-9);

  const DrivePlan back =
      plan("steps: [" + lane + ", {follow: {route: line, direction: reverse, lateral_offset_m: -1.3}}]");
  ASSERT_EQ(back.steps.size(), 5u);  // there, turn, across, turn, back
  EXPECT_NEAR(path(back, 2).length_m(), 2.6, 1e-6);
  EXPECT_NEAR(std::get<PlannedTurn>(back.steps[1]).angle_rad, M_PI / 2, 1e-6);
  EXPECT_LT((path(back, 4).end().position_m - Vec2(0, 1.3)).norm(), 1e-6);
}

TEST(DrivePlan, RepeatsLoops) {
  const DrivePlan p =
      plan("steps: [{loop: {times: 3, steps: [{turn: {angle_deg: 90}}, {rest: {duration_s: 2}}]}}]");
  ASSERT_EQ(p.steps.size(), 6u);
  EXPECT_NEAR(std::abs(std::get<PlannedTurn>(p.steps[4]).from_rad), M_PI, 1e-9);
  EXPECT_NEAR(p.duration_s({}), 3 * (2 + M_PI / 2 / 0.5 + 0.5 / 1.5), 1e-9);
}

TEST(DrivePlan, ExplainsWhatCannotBeDriven) {
  const auto has = [](const std::string& yaml, const std::string& text) {
    EXPECT_NE(error_of(yaml).find(text), std::string::npos) << error_of(yaml) << "\nlacks " << text;
  };
  has("steps: []", "drive.steps: expected at least one step");
  has("steps: [{rest: {}}, {follow: {route: rign}}]",
      "drive.steps[1].follow.route: no route \"rign\" in world \"plane\" (did you mean ring?)");
  has("steps: [{follow: {route: street}}]", "(one of: ring, line)");
  has("steps: [{follow: {route: line, laps: 2}}]", "laps: route \"line\" is not closed: at most 1");
  has("steps: [{follow: {route: line, direction: clockwise}}]",
      "not closed: its direction is forward or reverse");
  has("steps: [{follow: {route: line, start_s_m: 11}}]", "is 10.00 m long");
  has("start: {route: line, s_m: 11}\nsteps: [{rest: {}}]", "beyond the end of route \"line\" (10.00 m)");
  has("steps: [{follow: {route: line, speed_mps: 2}}]", "speed_mps: 2 is more than the robot's limit of 1.5");
  has("steps: [{turn: {rate_radps: 2}}]", "rate_radps: 2 is more than the robot's limit of 0.785");
  has("steps: [{follow: {}}]", "either a route or waypoints");
  has("steps: [{follow: {route: ring, waypoints: [{x_m: 1}]}}]", "either a route or waypoints");
  has("steps: [{follow: {waypoints: []}}]", "either a route or waypoints");
  has("steps: [{follow: {waypoints: [{x_m: 1}]}}]", "there is no way to go");
  has("steps: [{follow: {waypoints: [{x_m: nan}]}}]", "drive.yaml:1:37: x_m: expected");
  has("steps: [{follow: {route: ring, last_lap_offset_m: 1}}]", "more than one lap");
  has("steps: [{}]", "exactly one of rest, follow, turn, loop");
  has("steps: [{rest: {}, turn: {}}]", "exactly one of rest, follow, turn, loop");
  has("steps: [{loop: {times: 2}}]", "at least one step");
  has("steps: [{rest: {}, folow: {}}]", "did you mean follow?");
}

TEST(DrivePlan, RefusesScriptsMadeInCodeToo) {
  World world = routes_world(10, 5);
  DriveScript s;
  s.steps.resize(1);
  EXPECT_THROW(plan_drive(s, world, {}), InputError);
  s.steps[0].follow.emplace().waypoints = {{0, 0}, {std::nan(""), 0}};
  EXPECT_THROW(plan_drive(s, world, {}), InputError);
  s.steps[0].follow.emplace().route = "empty";
  world.routes.push_back({"empty", true, {}});
  EXPECT_THROW(plan_drive(s, world, {}), InputError);
  world.routes.back().points_world = {{0, 0, 0}, {1, std::nan(""), 0}};
  EXPECT_THROW(plan_drive(s, world, {}), InputError);
}

TEST(DriveScript, SavesWhatItLoads) {
  const std::string yaml = save_config(script(
      "start: {route: ring, s_m: 1.5}\nsteps:\n  - loop: {times: 2, steps: [{turn: {angle_deg: -30}}]}\n"
      "  - follow: {waypoints: [{x_m: 1, y_m: 2}], last_lap_offset_m: 0.2, laps: 1.5, direction: "
      "reverse}\n"));
  EXPECT_EQ(save_config(script(yaml)), yaml);
}

}  // namespace
}  // namespace vsslam

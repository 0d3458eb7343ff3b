#include "sim/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "sim/path.h"
#include "tests/sim/small_worlds.h"
#include "worlds/factory/world_source.h"

namespace vsslam {
namespace {

using testing::HasSubstr;

DriveScript script(const std::string& yaml) {
  DriveScript out;
  load_config_text(yaml, "drive.yaml", out);
  return out;
}

Vec3 position(const Simulation& simulation) {
  return simulation.trajectory().pose(simulation.trajectory().end()).translation;
}

void run(Simulation& simulation, double longest_s = 600) {
  simulation.advance(Time::from_seconds(longest_s));
}

// Largest distance of the truth from a polyline.
double largest_distance_m(const Trajectory& trajectory, const std::vector<Vec3>& corners) {
  double largest_m = 0;
  for (Time t = trajectory.begin(); t <= trajectory.end(); t = t + Duration{100'000'000}) {
    const Vec2 p = trajectory.pose(t).translation.head<2>();
    double nearest_m = 1e9;
    for (size_t i = 1; i < corners.size(); ++i) {
      const Vec2 a = corners[i - 1].head<2>(), side = corners[i].head<2>() - a;
      const double u = std::clamp(side.dot(p - a) / side.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (a + u * side - p).norm());
    }
    largest_m = std::max(largest_m, nearest_m);
  }
  return largest_m;
}

TEST(Simulation, StandsStillAtTimeZero) {
  const World world = plane_world();
  Simulation simulation(world, {},
                        script("start: {x_m: 1, y_m: 2, yaw_deg: 30}\nsteps: [{rest: {duration_s: 1}}]"));
  EXPECT_EQ(simulation.now(), Time{});
  simulation.advance(Time::from_seconds(0.5));
  EXPECT_EQ(simulation.trajectory().begin(), Time{});
  const Kinematics k = simulation.trajectory().at(Time{});
  EXPECT_LT((k.T_world_base.translation - Vec3(1, 2, base_height_m({}))).norm(), 1e-4);
  EXPECT_NEAR(k.T_world_base.rpy().z(), M_PI / 6, 1e-4);
  EXPECT_LT(k.a_world.norm() + k.v_world.norm() + k.omega_base.norm(), 1e-9);
  EXPECT_EQ(simulation.outcome(), DriveOutcome::driving);
  run(simulation);
  EXPECT_EQ(simulation.outcome(), DriveOutcome::finished);
  EXPECT_NEAR(simulation.now().seconds(), 1.0, 0.01);
  simulation.advance(Time::from_seconds(3));  // rests, and time goes on
  EXPECT_EQ(simulation.now(), Time::from_seconds(3));
}

TEST(Simulation, FollowsALapWithTurnsWithinBounds) {
  const World world = routes_world(4, 3);
  Simulation simulation(world, {},
                        script("steps: [{rest: {duration_s: 1}}, {follow: {route: ring, start_s_m: 3}}]"));
  const double expected_s = simulation.expected_duration_s();
  run(simulation);
  EXPECT_EQ(simulation.outcome(), DriveOutcome::finished) << simulation.outcome_text();
  EXPECT_LT((position(simulation).head<2>() - Vec2(4, 0)).norm(), 0.05);
  EXPECT_NEAR(simulation.now().seconds(), expected_s, 0.15 * expected_s);
  const std::vector<Vec3> corners{{4, -3, 0}, {4, 3, 0}, {-4, 3, 0}, {-4, -3, 0}, {4, -3, 0}};
  EXPECT_LT(largest_distance_m(simulation.trajectory(), corners), 0.15);
  EXPECT_LT(simulation.spline_deviation().translation_m, 1e-3);
  EXPECT_LT(simulation.spline_deviation().rotation_rad, 0.05 * M_PI / 180);
  EXPECT_GT(simulation.spline_deviation().translation_m, 1e-6);
}

TEST(Simulation, ObeysTheRobotsLimits) {
  const World world = routes_world(4, 3);
  const ScoutConfig scout;
  Simulation simulation(world, scout, script("steps: [{follow: {route: ring, speed_mps: 1.5, laps: 0.5}}]"));
  run(simulation);
  double fastest_mps = 0;
  const Trajectory& truth = simulation.trajectory();
  for (Time t = truth.begin(); t <= truth.end(); t = t + Duration{10'000'000}) {
    const Kinematics k = truth.at(t);
    fastest_mps = std::max(fastest_mps, k.v_world.norm());
    EXPECT_LT(std::abs(k.omega_base.z()), 1.05 * scout.max_yaw_rate_radps);
    EXPECT_LT(std::abs(k.v_world.normalized().dot(k.a_world)), scout.max_accel_mps2);
  }
  EXPECT_NEAR(fastest_mps, 1.5, 0.02);
}

TEST(Simulation, TurnsInPlace) {
  const World world = plane_world();
  Simulation simulation(world, {}, script("steps: [{turn: {angle_deg: 450}}, {turn: {angle_deg: -90}}]"));
  run(simulation);
  simulation.advance(simulation.now() + Duration{1'000'000'000});
  const SE3 T_world_base = simulation.trajectory().pose(simulation.trajectory().end());
  EXPECT_NEAR(T_world_base.rpy().z(), 0, 0.01);
  EXPECT_LT(T_world_base.translation.head<2>().norm(), 0.05);
  EXPECT_NEAR(simulation.now().seconds(), simulation.expected_duration_s() + 1, 1.5);
}

TEST(Simulation, DrivesBackOverSharpCorners) {
  const World world = plane_world();
  Simulation simulation(world, {},
                        script("steps: [{loop: {times: 2, steps: [{follow: {waypoints: [{x_m: 0, y_m: 0}, "
                               "{x_m: 3, y_m: 0}, {x_m: 0, y_m: 0}]}}]}}, {rest: {duration_s: 1}}]"));
  run(simulation);
  EXPECT_EQ(simulation.outcome(), DriveOutcome::finished) << simulation.outcome_text();
  EXPECT_LT(position(simulation).head<2>().norm(), 0.05);
}

TEST(Simulation, ReportsACollision) {
  World world = routes_world(4, 3);
  add_box(world, "bookcase", {3, -1, 0}, {3.2f, 1, 2});
  Simulation simulation(world, {}, script("steps: [{follow: {route: line}}]"));
  run(simulation);
  EXPECT_EQ(simulation.outcome(), DriveOutcome::collided);
  EXPECT_THAT(simulation.outcome_text(), HasSubstr("collided with bookcase at (2.5"));
  EXPECT_THAT(simulation.outcome_text(), HasSubstr("following line, 2.5 of 10.0 m (step 1 of 1)"));
  simulation.advance(simulation.now() + Duration{2'000'000'000});
  EXPECT_LT(position(simulation).x(), 2.6);
}

TEST(Simulation, ReportsBeingStuck) {
  const World world = routes_world(4, 3);
  Simulation stranded(world, {}, script("steps: [{follow: {route: line}}]"));
  stranded.scale_friction(Time{}, Time::from_seconds(500), 1e-4, 1e-4);
  run(stranded, 100);
  EXPECT_EQ(stranded.outcome(), DriveOutcome::stuck);
  EXPECT_THAT(stranded.outcome_text(), HasSubstr("stuck, no progress for 4 s at (0.0"));
}

TEST(Simulation, WheelsSlipWhereTheFloorIsSlippery) {
  const World world = routes_world(4, 3);
  Simulation simulation(world, {}, script("steps: [{follow: {route: line}}]"));
  simulation.scale_friction(Time{}, Time::from_seconds(3), 0.05, 0.05);
  simulation.advance(Time::from_seconds(2));
  // Commanded 0.8 m/s^2 up to 1 m/s; the floor gives mu g.
  const double accel_mps2 = 0.05 * 0.7 * kGravity_mps2;
  const WheelState wheels = simulation.wheels(Time::from_seconds(1));
  EXPECT_NEAR(wheels.slip_left_mps, wheels.left_radps * 0.16459 - accel_mps2, 0.02);
  EXPECT_NEAR(wheels.slip_right_mps, wheels.slip_left_mps, 0.03);
  EXPECT_GT(wheels.slip_left_mps, 0.3);
  EXPECT_NEAR(simulation.trajectory().at(Time::from_seconds(1)).v_world.norm(), accel_mps2, 0.02);
  run(simulation);
  EXPECT_EQ(simulation.outcome(), DriveOutcome::finished);
  const double rolled_m = 0.16459 * simulation.wheels(simulation.now()).left_rad;
  EXPECT_GT(rolled_m, position(simulation).x() + 0.3);  // odometry reads too much by what slipped
}

TEST(Simulation, RefusesAStartInsideAnObject) {
  World world = plane_world();
  add_box(world, "table", {0.3f, -1, 0}, {2, 1, 1});
  try {
    Simulation simulation(world, {}, script("steps: [{rest: {}}]"));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("drive.start: at ("));
    EXPECT_THAT(e.what(), HasSubstr("the robot touches table"));
  }
}

TEST(Simulation, DoorsOpenAndObjectsAppear) {
  World world = routes_world(4, 3);
  const int door = add_box(world, "door", {3, -1, 0}, {3.1f, 1, 2});
  Simulation open(world, {}, script("steps: [{follow: {route: line}}]"));
  open.advance(Time::from_seconds(1));
  open.set_object_pose(door, Eigen::Affine3d(Eigen::Translation3d(0, 5, 0)), true);
  run(open);
  EXPECT_EQ(open.outcome(), DriveOutcome::finished) << open.outcome_text();
  Simulation shut(world, {}, script("steps: [{follow: {route: line}}]"));
  shut.set_object_pose(door, Eigen::Affine3d::Identity(), false);
  shut.advance(Time::from_seconds(2));
  shut.set_object_pose(door, Eigen::Affine3d::Identity(), true);
  run(shut);
  EXPECT_EQ(shut.outcome(), DriveOutcome::collided);
}

// The robot steers by what it is told: told that it is 0.3 m left of where it is, it drives 0.3 m to the right.
TEST(Simulation, ClosedLoopDrivesOnTheBelievedPose) {
  const World world = routes_world(4, 3);
  Simulation simulation(world, {}, script("steps: [{follow: {route: line}}]"));
  const Duration latency{200'000'000};
  for (Time t{200'000'000}; simulation.outcome() == DriveOutcome::driving; t = t + Duration{100'000'000}) {
    simulation.advance(t);
    const Time seen = simulation.now() - latency;
    if (seen < simulation.trajectory().begin() || seen > simulation.trajectory().end()) continue;
    SE3 T_world_base = simulation.trajectory().pose(seen);
    T_world_base.translation.y() += 0.3;
    simulation.set_believed_pose(seen, T_world_base);
    simulation.forget_before(seen);
  }
  EXPECT_EQ(simulation.outcome(), DriveOutcome::finished) << simulation.outcome_text();
  EXPECT_NEAR(position(simulation).y(), -0.3, 0.02);
  EXPECT_NEAR(position(simulation).x(), 10, 0.05);
}

// Without further poses the wheels carry the belief on.
TEST(Simulation, ClosedLoopCarriesAnOldPoseOnByTheWheels) {
  const World world = routes_world(4, 3);
  Simulation simulation(world, {}, script("steps: [{follow: {route: line}}]"));
  simulation.set_believed_pose(Time{}, SE3({1, 0, 0, 0}, {0, 0, base_height_m({})}));
  run(simulation);
  EXPECT_EQ(simulation.outcome(), DriveOutcome::finished) << simulation.outcome_text();
  EXPECT_LT((position(simulation).head<2>() - Vec2(10, 0)).norm(), 0.1);
}

TEST(Simulation, VibratesOnPurposeOnly) {
  const World world = routes_world(4, 3);
  ScoutConfig scout;
  scout.vibration_accel_mps2 = 0.5;
  scout.vibration_rate_radps = 0.02;
  Simulation simulation(world, scout, script("steps: [{rest: {duration_s: 1}}, {follow: {route: line}}]"));
  run(simulation);
  double accel2 = 0, rate2 = 0;
  int count = 0;
  for (Time t = Time::from_seconds(4); t < Time::from_seconds(8); t = t + Duration{1'000'000}, ++count) {
    const Kinematics k = simulation.trajectory().at(t);
    accel2 += k.a_world.z() * k.a_world.z();
    rate2 += k.omega_base.y() * k.omega_base.y();
  }
  EXPECT_NEAR(std::sqrt(accel2 / count), 0.5, 0.1);
  EXPECT_NEAR(std::sqrt(rate2 / count), 0.02, 0.004);
  EXPECT_LT(simulation.trajectory().at(Time::from_seconds(0.5)).a_world.norm(), 1e-9);
  EXPECT_LT(simulation.spline_deviation().translation_m, 1e-3);
  EXPECT_LT(simulation.spline_deviation().rotation_rad, 0.05 * M_PI / 180);
}

TEST(Simulation, IsTheSameInAnyPortions) {
  World world = routes_world(2, 2);
  world.floor.unevenness_m = 0.002;
  const DriveScript drive = script("steps: [{follow: {route: ring, laps: 0.4}}]");
  Simulation a(world, {}, drive), b(world, {}, drive);
  a.advance(Time::from_seconds(6));
  for (int64_t i = 0; i < 600; ++i) {
    b.advance(Time{i * 10'000'000 + 3});
    b.forget_before(b.now() - Duration{1'000'000'000});
  }
  b.advance(Time::from_seconds(6));
  for (Time t = b.trajectory().begin(); t <= a.trajectory().end(); t = t + Duration{7'000'001}) {
    EXPECT_EQ(a.trajectory().pose(t).translation, b.trajectory().pose(t).translation);
    EXPECT_EQ(a.trajectory().pose(t).rotation.coeffs(), b.trajectory().pose(t).rotation.coeffs());
    EXPECT_EQ(a.wheels(t).left_rad, b.wheels(t).left_rad);
    EXPECT_EQ(a.wheels(t).slip_right_mps, b.wheels(t).slip_right_mps);
  }
  EXPECT_LT(b.trajectory().knot_count(), 120u);
}

TEST(Simulation, WheelStateIsInterpolated) {
  const World world = routes_world(4, 3);
  Simulation simulation(world, {}, script("steps: [{follow: {route: line}}]"));
  simulation.advance(Time::from_seconds(3));
  const WheelState a = simulation.wheels(Time{2'000'000'000}), b = simulation.wheels(Time{2'001'000'000});
  const WheelState middle = simulation.wheels(Time{2'000'500'000});
  EXPECT_NEAR(middle.left_rad, 0.5 * (a.left_rad + b.left_rad), 1e-12);
  EXPECT_NEAR((b.left_rad - a.left_rad) / 1e-3, middle.left_radps, 1e-3);
  EXPECT_NEAR(middle.left_radps * 0.16459, 1.0, 1e-3);
  EXPECT_DEATH(simulation.wheels(Time{3'000'000'001}), "wheels: asked for 3000000001 ns");
}

// The default corridor ring at 1 m/s: a lap and a bit, the last part beside the first.
TEST(Simulation, LapsTheCorridorRing) {
  const World world = make_world({});
  Simulation simulation(world, {},
                        script("steps: [{follow: {route: ring, laps: 1.05, last_lap_offset_m: 0.4}}]"));
  while (simulation.outcome() == DriveOutcome::driving) {
    simulation.advance(simulation.now() + Duration{1'000'000'000});
    simulation.forget_before(simulation.now() - Duration{1'000'000'000});
  }
  EXPECT_EQ(simulation.outcome(), DriveOutcome::finished) << simulation.outcome_text();
  EXPECT_LT(simulation.spline_deviation().translation_m, 1e-3);
  EXPECT_LT(simulation.spline_deviation().rotation_rad, 0.05 * M_PI / 180);
}

}  // namespace
}  // namespace vsslam

#include "sim/dynamics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/trajectory.h"
#include "tests/sim/small_worlds.h"

namespace vsslam {
namespace {

struct Drive {
  RobotState state;
  Trajectory trajectory;
};

// Ramps the wheels to these surface speeds at 0.8 m/s^2 and keeps them.
Drive drive(const World& world, const ScoutConfig& scout, double left_mps, double right_mps,
            double duration_s, double friction = 1.0) {
  Dynamics dynamics(world, scout, 1, 2, 0.3);
  Drive out;
  double left = 0, right = 0;
  const double most = 0.8e-3;
  const int steps = static_cast<int>(duration_s * 1000);
  for (int i = 0; i <= steps; ++i) {
    if (i % 10 == 0) out.trajectory.push(Time{i * Dynamics::kStep_ns}, dynamics.state().T_world_base);
    left += std::clamp(left_mps - left, -most, most);
    right += std::clamp(right_mps - right, -most, most);
    dynamics.step({left / scout.wheel_radius_m, right / scout.wheel_radius_m}, {friction, friction});
  }
  out.state = dynamics.state();
  return out;
}

Vec3 v_base(const RobotState& state) {
  return state.T_world_base.rotation.conjugate() * state.v_world;
}

TEST(Dynamics, RestsOnItsTyresWithoutCreeping) {
  const ScoutConfig scout;
  World world = plane_world();
  world.floor.height_m = 0.7;
  Dynamics dynamics(world, scout, 1, 2, 0.3);
  for (int i = 0; i < 1000; ++i) dynamics.step({}, {1, 1});
  const RobotState settled = dynamics.state();
  EXPECT_NEAR(settled.T_world_base.translation.z(), 0.7 + base_height_m(scout), 1e-6);
  EXPECT_NEAR(base_height_m(scout), 0.0702 + 0.16459 - 82 * 9.80665 / (4 * scout.tyre_stiffness_npm), 1e-12);
  EXPECT_LT((settled.T_world_base.rpy() - Vec3(0, 0, 0.3)).norm(), 1e-4);
  for (int i = 0; i < 5000; ++i) dynamics.step({}, {1, 1});
  EXPECT_EQ(dynamics.state().T_world_base.translation, settled.T_world_base.translation);
  EXPECT_EQ(dynamics.state().v_world, Vec3(0, 0, 0));
}

// The accelerations that an IMU would feel while cruising: an MTi-300 has 5.9e-3 m/s^2 of noise.
TEST(Dynamics, CruisesWithoutJitter) {
  const Drive cruise = drive(plane_world(), {}, 1, 1, 5);
  EXPECT_NEAR(v_base(cruise.state).x(), 1.0, 2e-4);
  for (int64_t ms = 3000; ms < 4900; ms += 7) {
    const Kinematics k = cruise.trajectory.at(Time{ms * 1'000'000});
    EXPECT_LT(k.a_world.norm(), 5e-5);
    EXPECT_LT(k.omega_base.norm(), 1e-4);
  }
}

// Four equal sliding contacts: w = w_commanded W^2 / (L^2 + W^2), see effective_track_m.
TEST(Dynamics, SpinsAsCoulombFrictionSays) {
  const ScoutConfig scout;
  const double commanded_radps = 0.5;
  const double v = 0.5 * commanded_radps * scout.track_m;
  for (const double friction : {1.0, 0.4}) {
    const RobotState state = drive(plane_world(), scout, -v, v, 3, friction).state;
    const double w2 = scout.track_m * scout.track_m, l2 = scout.wheelbase_m * scout.wheelbase_m;
    EXPECT_NEAR(state.omega_world.z(), commanded_radps * w2 / (w2 + l2), 2e-4);
    EXPECT_NEAR(state.omega_world.z(), 2 * v / effective_track_m(scout), 2e-4);
    EXPECT_NEAR(state.omega_world.z(), 0.2891, 2e-4);
  }
}

// Residuals of the steady turn: forces and moment of four sliding wheels, less mass times acceleration. The load moves
// outwards with the centrifugal force and, as the wheels are gyroscopes (m r^2 / 2 each, at V / r), by as much again as
// if the centre of mass were higher by 2 m_wheel r / m. Unknowns: forward and lateral speed, yaw rate.
Vec3 steady_turn_residual(const ScoutConfig& scout, const Vec3& x, double left_mps, double right_mps) {
  const double m = total_mass_kg(scout), wheel_kg = scout.wheel_mass_kg;
  const double height_m = base_height_m(scout) - 4 * wheel_kg / m * scout.axle_below_base_m;
  const double rolling_height_m = height_m + 2 * wheel_kg * scout.wheel_radius_m / m;
  const Vec3 a(-x[2] * x[1], x[2] * x[0], 0);
  Vec3 out(-m * a.x(), -m * a.y(), 0);
  for (const double px : {0.5 * scout.wheelbase_m, -0.5 * scout.wheelbase_m})
    for (const double py : {0.5 * scout.track_m, -0.5 * scout.track_m}) {
      const double load_n =
          m * (kGravity_mps2 / 4 - a.x() * height_m / (4 * px) - a.y() * rolling_height_m / (4 * py));
      const Vec3 slip(x[0] - x[2] * py - (py > 0 ? left_mps : right_mps), x[1] + x[2] * px, 0);
      const Vec3 force = -scout.friction * load_n * slip.normalized();
      out += Vec3(force.x(), force.y(), px * force.y() - py * force.x());
    }
  return out;
}

TEST(Dynamics, TurnsOnAnArcAsTheForceBalanceSays) {
  const ScoutConfig scout;
  Vec3 x(1.0, -0.001, 0.4 / effective_track_m(scout));
  for (int i = 0; i < 100; ++i) {
    Mat3 slope;
    const Vec3 r = steady_turn_residual(scout, x, 0.8, 1.2);
    for (int k = 0; k < 3; ++k)
      slope.col(k) = (steady_turn_residual(scout, x + 1e-7 * Vec3::Unit(k), 0.8, 1.2) - r) / 1e-7;
    x -= 0.5 * slope.inverse() * r;
  }
  ASSERT_LT(steady_turn_residual(scout, x, 0.8, 1.2).norm(), 1e-6);
  const RobotState state = drive(plane_world(), scout, 0.8, 1.2, 5).state;
  EXPECT_NEAR(state.omega_world.z(), x[2], 1e-4);
  EXPECT_NEAR(v_base(state).x(), x[0], 1e-4);
  EXPECT_NEAR(v_base(state).y(), x[1], 1e-3);
}

// Locked wheels on a slippery floor: deceleration mu g, and the slip is the ground speed.
TEST(Dynamics, BrakesByFriction) {
  const ScoutConfig scout;
  Dynamics dynamics(plane_world(), scout, 0, 0, 0);
  double speed_mps = 0;
  for (; speed_mps < 1; speed_mps += 0.8e-3)
    dynamics.step({speed_mps / scout.wheel_radius_m, speed_mps / scout.wheel_radius_m}, {1, 1});
  for (int i = 0; i < 100; ++i) dynamics.step({}, {0.1, 0.1});
  const RobotState before = dynamics.state();
  for (int i = 0; i < 500; ++i) dynamics.step({}, {0.1, 0.1});
  const RobotState after = dynamics.state();
  EXPECT_NEAR((before.v_world.x() - after.v_world.x()) / 0.5, 0.1 * scout.friction * kGravity_mps2, 2e-3);
  for (const double slip_mps : after.slip_mps) EXPECT_NEAR(slip_mps, -after.v_world.x(), 1e-3);
}

// A step of the command: 4 torques against the mass and the wheels' inertia (m r^2 / 2 each).
TEST(Dynamics, MotorsPushWithTheirTorqueOnly) {
  ScoutConfig scout;
  scout.wheel_torque_limit_nm = 5;
  Dynamics dynamics(plane_world(), scout, 0, 0, 0);
  for (int i = 0; i < 500; ++i) dynamics.step({}, {1, 1});
  for (int i = 0; i < 500; ++i) dynamics.step({9, 9}, {1, 1});
  const double inert_kg = total_mass_kg(scout) + 4 * 0.5 * scout.wheel_mass_kg;
  EXPECT_NEAR(dynamics.state().v_world.x() / 0.5, 4 * 5 / scout.wheel_radius_m / inert_kg, 0.01);
}

TEST(Dynamics, WheelsCountTheWay) {
  const ScoutConfig scout;
  const RobotState state = drive(plane_world(), scout, 1, 1, 12).state;  // many turns of the wheels
  const double way_m = (state.T_world_base.translation.head<2>() - Eigen::Vector2d(1, 2)).norm();
  EXPECT_GT(way_m, 10);
  for (const double rad : state.wheel_rad) EXPECT_NEAR(rad * scout.wheel_radius_m, way_m, 0.002 * way_m);
  const RobotState back = drive(plane_world(), scout, -1, -1, 4).state;
  EXPECT_LT(back.wheel_rad[kRearLeft], -15);
}

// On slow waves the robot follows the floor, and what it feels is the floor, not contact jitter: nothing above the
// passing frequency of the wheels.
TEST(Dynamics, FollowsAnUnevenFloorSmoothly) {
  World world = plane_world();
  world.floor.unevenness_m = 0.004;
  world.floor.wavelength_m = 4;
  const Drive uneven = drive(world, {}, 1, 1, 8);
  double climbed = 0, jump = 0;
  for (int64_t ms = 4000; ms < 7900; ms += 10) {
    const Kinematics k = uneven.trajectory.at(Time{ms * 1'000'000});
    const Kinematics next = uneven.trajectory.at(Time{(ms + 10) * 1'000'000});
    const Vec3& p = k.T_world_base.translation;
    EXPECT_NEAR(p.z(), world.floor.height(p.x(), p.y()) + base_height_m({}), 0.003);
    climbed = std::max(climbed, std::abs(k.T_world_base.rpy().y()));
    jump = std::max(jump, (next.a_world - k.a_world).norm());
  }
  EXPECT_GT(climbed, 0.001);
  EXPECT_LT(jump, 0.01);
}

TEST(Dynamics, TouchesMeshesButNotTheFloor) {
  World world = plane_world();
  add_box(world, "sill", {0.4f, -1, 0}, {0.5f, 1, 0.02f});  // low enough to be driven over
  const int wall = add_box(world, "wall", {2, -1, 0}, {2.1f, 1, 1});
  Dynamics dynamics(world, {}, 0, 0, 0);
  int steps = 0;
  for (; steps < 4000 && dynamics.touched_object() < 0; ++steps)
    dynamics.step({std::min(1.0, 0.002 * steps) * 5, std::min(1.0, 0.002 * steps) * 5}, {1, 1});
  EXPECT_EQ(dynamics.touched_object(), wall);
  EXPECT_NEAR(dynamics.state().T_world_base.translation.x(), 2 - 0.5 * ScoutConfig{}.hull_length_m, 0.005);
}

TEST(Dynamics, WhatIsFarAtTheStartIsThereWhenTheRobotIs) {
  World world = plane_world();
  const int wall = add_box(world, "wall", {12, -1, 0}, {12.1f, 1, 1}),
            door = add_box(world, "door", {8, -1, 0}, {8.1f, 1, 1});
  Dynamics dynamics(world, {}, 0, 0, 0);
  const auto drive_into_something = [&] {
    for (int steps = 0; steps < 30000 && dynamics.touched_object() < 0; ++steps)
      dynamics.step({std::min(1.0, 0.002 * steps) * 5, std::min(1.0, 0.002 * steps) * 5}, {1, 1});
    return dynamics.touched_object();
  };
  EXPECT_EQ(drive_into_something(), door);
  dynamics.set_object_pose(door, Eigen::Affine3d::Identity(), false);
  dynamics.step({}, {1, 1});
  EXPECT_EQ(drive_into_something(), wall);
  EXPECT_NEAR(dynamics.state().T_world_base.translation.x(), 12 - 0.5 * ScoutConfig{}.hull_length_m,
              0.05);  // a little askew after the door
}

TEST(Dynamics, ObjectsAreWhereTheirPlacementSays) {
  World world = plane_world();
  const int box = add_box(world, "box", {-0.5f, -0.5f, 0}, {0.5f, 0.5f, 1});
  const auto place = [](double x, double yaw, double scale) {
    return Eigen::Affine3d(Eigen::Translation3d(x, 0, 0) * Eigen::AngleAxisd(yaw, Vec3::UnitZ()) *
                           Eigen::Scaling(1.0, scale, 1.0));
  };
  const auto touches = [](Dynamics& dynamics) {
    dynamics.step({}, {1, 1});
    return dynamics.touched_object() >= 0;
  };
  // The second object shares the mesh; scaled and turned a quarter it reaches 1.5 m along x.
  world.objects[static_cast<size_t>(box)].T_world_object = place(10, 0, 1);
  world.objects.push_back({.name = "long", .mesh = 0, .T_world_object = place(1.9, M_PI / 2, 3)});
  Dynamics near(world, {}, 0, 0, 0);
  EXPECT_TRUE(touches(near));
  world.objects.back().T_world_object = place(2.1, M_PI / 2, 3);
  Dynamics far(world, {}, 0, 0, 0);
  EXPECT_FALSE(touches(far));
  far.set_object_pose(box, place(0.9, 0, 1), true);
  EXPECT_TRUE(touches(far));
  far.set_object_pose(box, place(0.9, 0, 1), false);
  EXPECT_FALSE(touches(far));
  far.set_object_pose(box, place(0.9, 0, 1), true);
  EXPECT_TRUE(touches(far));
  far.set_object_pose(box, place(1.1, 0, 1), true);
  EXPECT_FALSE(touches(far));
}

TEST(Dynamics, ObjectsWithoutCollisionOrTrianglesAreAir) {
  World world = plane_world();
  add_box(world, "ghost", {-1, -1, 0}, {1, 1, 1});
  world.objects[0].collision = Collision::none;
  world.meshes.push_back({"nothing", {}});
  world.objects.push_back({.name = "nothing", .mesh = 1});
  Dynamics dynamics(world, {}, 0, 0, 0);
  dynamics.step({}, {1, 1});
  EXPECT_EQ(dynamics.touched_object(), -1);
  dynamics.set_object_pose(0, Eigen::Affine3d::Identity(), true);
  dynamics.step({}, {1, 1});
  EXPECT_EQ(dynamics.touched_object(), -1);
}

TEST(Dynamics, RepeatsToTheBit) {
  World world = plane_world();
  world.floor.unevenness_m = 0.003;
  const RobotState a = drive(world, {}, 0.3, 0.9, 2).state, b = drive(world, {}, 0.3, 0.9, 2).state;
  EXPECT_EQ(a.T_world_base.translation, b.T_world_base.translation);
  EXPECT_EQ(a.T_world_base.rotation.coeffs(), b.T_world_base.rotation.coeffs());
  EXPECT_EQ(a.wheel_rad, b.wheel_rad);
}

}  // namespace
}  // namespace vsslam

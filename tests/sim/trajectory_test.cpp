#include "sim/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vsslam {
namespace {

constexpr int64_t kKnot_ns = 10'000'000;

// A path with known derivatives: a helix, turning about a tilted axis.
SE3 helix(double t_s) {
  const Vec3 p(2 * std::cos(0.7 * t_s), 2 * std::sin(0.7 * t_s), 0.3 * t_s);
  return {so3_exp(Vec3(0.1, -0.2, 0.9) * std::sin(1.3 * t_s)) * so3_exp(Vec3(0.3, 0.1, 0) * t_s), p};
}

Trajectory record(int knots, Time start = {}) {
  Trajectory trajectory;
  for (int n = 0; n < knots; ++n) {
    const Time stamp{start.ns + n * kKnot_ns};
    trajectory.push(stamp, helix(stamp.seconds()));
  }
  return trajectory;
}

TEST(Trajectory, SpansAllButTheOutermostKnots) {
  const Trajectory trajectory = record(10, Time{-kKnot_ns});
  EXPECT_EQ(trajectory.begin().ns, 0);
  EXPECT_EQ(trajectory.end().ns, 7 * kKnot_ns);
  EXPECT_EQ(trajectory.pose(trajectory.begin()).translation,
            trajectory.at(trajectory.begin()).T_world_base.translation);
  EXPECT_DEATH(trajectory.pose(Time{-1}), "asked for -1 ns");
  EXPECT_DEATH(trajectory.at(Time{7 * kKnot_ns + 1}), "defined from 0 to 70000000 ns");
}

TEST(Trajectory, RefusesAKnotOutOfStep) {
  Trajectory trajectory = record(3);
  EXPECT_DEATH(trajectory.push(Time{3 * kKnot_ns + 1}, SE3{}), "expected at 30000000 ns");
}

TEST(Trajectory, ReproducesConstantVelocityAndTurnExactly) {
  const Vec3 v(1.0, -0.5, 0.25), omega(0, 0, 0.6);
  Trajectory trajectory;
  for (int n = 0; n < 50; ++n) {
    const double t = n * 0.01;
    trajectory.push(Time{n * kKnot_ns}, SE3(so3_exp(omega * t), v * t));
  }
  for (int64_t ns = trajectory.begin().ns; ns <= trajectory.end().ns; ns += 1'234'567) {
    const Kinematics k = trajectory.at(Time{ns});
    const double t = static_cast<double>(ns) * 1e-9;
    EXPECT_LT((k.T_world_base.translation - v * t).norm(), 1e-14);
    EXPECT_LT(so3_log(k.T_world_base.rotation.conjugate() * so3_exp(omega * t)).norm(), 1e-14);
    EXPECT_LT((k.v_world - v).norm(), 1e-13);
    EXPECT_LT((k.omega_base - omega).norm(), 1e-13);
    EXPECT_LT(k.a_world.norm(), 1e-10);
    EXPECT_LT(k.alpha_base.norm(), 1e-10);
  }
}

TEST(Trajectory, DerivativesAgreeWithDifferences) {
  const Trajectory trajectory = record(60);
  const int64_t h_ns = 20'000;
  const double h = 2e-5;
  for (int64_t ns = 12'345'678; ns < 570'000'000; ns += 7'777'777) {
    const int64_t in_segment = ns % kKnot_ns;
    if (in_segment < h_ns || in_segment > kKnot_ns - h_ns) continue;  // third derivatives jump at knots
    const Kinematics before = trajectory.at(Time{ns - h_ns}), now = trajectory.at(Time{ns}),
                     after = trajectory.at(Time{ns + h_ns});
    const SE3 &a = before.T_world_base, &b = after.T_world_base;
    EXPECT_LT(((b.translation - a.translation) / (2 * h) - now.v_world).norm(), 1e-8);
    EXPECT_LT(((after.v_world - before.v_world) / (2 * h) - now.a_world).norm(), 1e-7);
    EXPECT_LT((so3_log(a.rotation.conjugate() * b.rotation) / (2 * h) - now.omega_base).norm(), 1e-8);
    EXPECT_LT(((after.omega_base - before.omega_base) / (2 * h) - now.alpha_base).norm(), 1e-6);
    EXPECT_GT(now.alpha_base.norm() + now.a_world.norm(), 0.1);
  }
}

TEST(Trajectory, IsC2AcrossKnots) {
  const Trajectory trajectory = record(60);
  for (int n = 2; n < 57; ++n) {
    const Kinematics left = trajectory.at(Time{n * kKnot_ns - 1}), right = trajectory.at(Time{n * kKnot_ns});
    EXPECT_LT((left.T_world_base.translation - right.T_world_base.translation).norm(), 1e-8);
    EXPECT_LT((left.v_world - right.v_world).norm(), 1e-8);
    EXPECT_LT((left.a_world - right.a_world).norm(), 1e-7);
    EXPECT_LT((left.omega_base - right.omega_base).norm(), 1e-8);
    EXPECT_LT((left.alpha_base - right.alpha_base).norm(), 1e-7);
  }
}

TEST(Trajectory, PassesControlPosesByASixthOfTheSecondDifference) {
  const Trajectory trajectory = record(60);
  for (int n = 5; n < 50; ++n) {
    const double t = n * 0.01;
    const Vec3 second_difference =
        helix(t - 0.01).translation - 2 * helix(t).translation + helix(t + 0.01).translation;
    const SE3 T_world_base = trajectory.pose(Time{n * kKnot_ns});
    EXPECT_LT((T_world_base.translation - helix(t).translation - second_difference / 6).norm(), 1e-14);
    EXPECT_LT(so3_log(T_world_base.rotation.conjugate() * helix(t).rotation).norm(), 1e-4);
  }
}

// What the IMU would feel, integrated in small steps, leads back to the pose.
TEST(Trajectory, KinematicsIntegrateToThePose) {
  const Trajectory trajectory = record(600);
  const int64_t step_ns = 100'000;
  const double dt = 1e-4;
  Kinematics now = trajectory.at(trajectory.begin());
  SE3 T_world_base = now.T_world_base;
  Vec3 v_world = now.v_world;
  for (int64_t ns = trajectory.begin().ns; ns + step_ns <= trajectory.end().ns; ns += step_ns) {
    const Kinematics middle = trajectory.at(Time{ns + step_ns / 2});
    T_world_base.translation += v_world * dt + 0.5 * dt * dt * middle.a_world;
    v_world += dt * middle.a_world;
    T_world_base.rotation = T_world_base.rotation * so3_exp(middle.omega_base * dt);
  }
  const SE3 T_world_base_end = trajectory.pose(trajectory.end());
  EXPECT_LT((T_world_base.translation - T_world_base_end.translation).norm(), 1e-6);
  EXPECT_LT(so3_log(T_world_base.rotation.conjugate() * T_world_base_end.rotation).norm(), 1e-6);
}

TEST(Trajectory, ForgettingKeepsWhatIsAsked) {
  Trajectory trajectory = record(1000);
  const Trajectory whole = trajectory;
  const Time from = Time::from_seconds(5.1234);
  trajectory.forget_before(from);
  EXPECT_LE(trajectory.begin(), from);
  EXPECT_GT(trajectory.begin(), from - trajectory.knot_interval());
  EXPECT_EQ(trajectory.end(), whole.end());
  EXPECT_LT(trajectory.knot_count(), 500u);
  for (Time t = from; t <= trajectory.end(); t = t + Duration{3'333'333}) {
    EXPECT_EQ(trajectory.pose(t).translation, whole.pose(t).translation);
    EXPECT_EQ(trajectory.pose(t).rotation.coeffs(), whole.pose(t).rotation.coeffs());
  }
  trajectory.forget_before(Time::from_seconds(1e6));
  EXPECT_EQ(trajectory.end(), whole.end());
}

}  // namespace
}  // namespace vsslam

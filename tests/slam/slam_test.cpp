#include "slam/slam.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/slam/drive.h"

namespace vsslam {
namespace {

using namespace testing_scene;

Motion circle_in_room() {
  return [](double t) {
    const double u = std::max(t - 1.0, 0.0);
    const double angle = 0.3 * (u < 1 ? u * u * u * (1 - u / 2) : u - 0.5);
    return SE3::from_rpy({0, 0, angle + 0.5 * std::numbers::pi},
                         {1.8 * std::cos(angle) - 0.5, 1.8 * std::sin(angle), 0.2});
  };
}

TEST(Slam, HoldsItsPlaceInARoomToMillimetres) {
  DriveOptions options;
  options.duration_s = 12;
  const Driven driven = drive(room(), circle_in_room(), options);
  EXPECT_LT(driven.position_rmse_m, 0.005);
  EXPECT_LT(driven.worst_m, 0.02);
  EXPECT_LT(driven.worst_rotation_rad, 0.003);
  for (size_t i = 1; i < driven.reports.size(); ++i) {
    EXPECT_TRUE(driven.reports[i].converged) << i;
    EXPECT_LE(driven.reports[i].degenerate_directions, 1) << i;
  }
}

TEST(Slam, KeepsTheWheelsDistanceInAnEndlessCorridor) {
  DriveOptions options;
  options.duration_s = 12;
  options.wheel_scale = 1.02;
  for (const PriorKind prior : {PriorKind::wheel, PriorKind::wheel_imu}) {
    options.config.prior = prior;
    const Driven driven = drive(corridor(400), weaving_drive(0, 1.0), options);
    for (const ScanReport& report : driven.reports) EXPECT_GE(report.degenerate_directions, 1) << report.scan;
    const SE3 error = driven.T_odom_base_true.back().inverse() * driven.reports.back().T_odom_base;
    const double by_wheels_m = 0.02 * driven.path_m;
    if (prior == PriorKind::wheel) {  // nothing else is known along the axis
      EXPECT_NEAR(error.translation.x(), by_wheels_m, 0.02);
    } else {  // an accelerometer that began at rest knows something
      EXPECT_GT(error.translation.x(), -0.02);
      EXPECT_LT(error.translation.x(), by_wheels_m + 0.02);
    }
    EXPECT_NEAR(error.translation.y(), 0, 0.03);
  }
}

TEST(Slam, CorrectsTheWheelsWhereJambsAreSeen) {
  DriveOptions options;
  options.duration_s = 20;
  options.wheel_scale = 1.03;
  const Driven driven = drive(jambed_corridor(150, 4, 0.15), weaving_drive(0, 1.0), options);
  EXPECT_LT(driven.position_rmse_m, 0.002 * driven.path_m);
}

TEST(Slam, APriorWithoutItsSensorsIsSaid) {
  SlamConfig config;
  config.prior = PriorKind::vio;
  Odometry odometry(config, {});
  odometry.add(ImuSample{Time{1}, Vec3::Zero(), {0, 0, 9.8}, std::nullopt});
  ASSERT_EQ(odometry.health().warnings.size(), 1u);
  EXPECT_NE(odometry.health().warnings[0].find("a camera, and there is none"), std::string::npos);
}

class SlamWithPrior : public ::testing::TestWithParam<PriorKind> {};
TEST_P(SlamWithPrior, HoldsItsPlaceInARoom) {
  DriveOptions options;
  options.duration_s = 8;
  options.config.prior = GetParam();
  const Driven driven = drive(room(), circle_in_room(), options);
  EXPECT_LT(driven.position_rmse_m, 0.01);
  EXPECT_LT(driven.worst_m, 0.05);
}
INSTANTIATE_TEST_SUITE_P(All, SlamWithPrior,
                         ::testing::Values(PriorKind::wheel_imu, PriorKind::imu, PriorKind::wheel,
                                           PriorKind::constant_velocity));

// Whatever fails, poses stay finite and the room brings the robot back.
void expect_recovers(DriveOptions options) {
  options.duration_s = 9;
  const Driven driven = drive(room(), circle_in_room(), options);
  for (const ScanReport& report : driven.reports) {
    EXPECT_TRUE(report.T_odom_base.translation.allFinite());
    EXPECT_TRUE(report.T_odom_base.rotation.coeffs().allFinite());
  }
  const SE3 error = driven.T_odom_base_true.back().inverse() * driven.reports.back().T_odom_base;
  EXPECT_LT(error.translation.norm(), 0.02);
  EXPECT_LT(error.angle(), 0.01);
}
bool between_s(Time t, double from_s, double to_s) {
  return t.seconds() >= from_s && t.seconds() < to_s;
}

TEST(SlamSurvives, TwoSecondsWithoutLidar) {
  DriveOptions options;
  options.keep = [](char kind, Time t) { return kind != 'l' || !between_s(t, 4, 6); };
  expect_recovers(options);
}
TEST(SlamSurvives, NoImuAtAll) {
  DriveOptions options;
  options.keep = [](char kind, Time) { return kind != 'i'; };
  expect_recovers(options);
}
TEST(SlamSurvives, NoWheelsAtAll) {
  DriveOptions options;
  options.keep = [](char kind, Time) { return kind != 'w'; };
  expect_recovers(options);
}
TEST(SlamSurvives, ImuAndWheelsDropOutForASecond) {
  DriveOptions options;
  options.keep = [](char kind, Time t) { return kind == 'l' || !between_s(t, 3, 4); };
  expect_recovers(options);
}
TEST(SlamSurvives, SpikesAndNonsenseFromTheImu) {
  DriveOptions options;
  options.corrupt_imu = [](ImuSample& sample) {
    const int64_t n = sample.stamp.ns / 10'000'000;
    if (n % 37 == 5) sample.gyro_radps = Vec3::Constant(7.8);
    if (n % 53 == 7) sample.gyro_radps.y() = std::numeric_limits<double>::quiet_NaN();
    if (n % 41 == 9) sample.accel_mps2 = Vec3::Constant(-200);
  };
  expect_recovers(options);
}
// Whatever the IMU says that cannot be, the result is hardly worse than that of the LiDAR alone.
// An IMU is as quiet at a constant speed as at rest.
TEST(Slam, StartsInSteadyMotion) {
  DriveOptions options;
  options.duration_s = 5;
  const Motion straight = [](double t) { return SE3::from_rpy({0, 0, 0.3}, {-4 + 0.8 * t, -2 + 0.25 * t, 0.2}); };
  for (const PriorKind prior : {PriorKind::imu, PriorKind::wheel_imu}) {
    options.config.prior = prior;
    EXPECT_LT(drive(room(), straight, options).position_rmse_m, 0.01);
  }
}

TEST(Slam, APriorThatContradictsIsNotBelieved) {
  DriveOptions options;
  options.duration_s = 8;
  options.config.prior = PriorKind::constant_velocity;
  const double alone_m = drive(room(), circle_in_room(), options).position_rmse_m;
  const double gravity_mps2 = rig().imu.gravity_mps2;
  const Vec3 up_imu = rig().imu.T_base_imu.rotation.conjugate() * Vec3::UnitZ();
  const Mat3 half_turn = so3_exp(std::numbers::pi * up_imu.unitOrthogonal()).toRotationMatrix();
  const std::string kDegrees = "rates in degrees";
  const std::vector<std::pair<std::string, std::function<void(ImuSample&)>>> faults = {
      {"force in g", [&](ImuSample& s) { s.accel_mps2 /= gravity_mps2; }},
      {kDegrees, [](ImuSample& s) { s.gyro_radps *= 180 / std::numbers::pi; }},
      {"no gravity", [&](ImuSample& s) { s.accel_mps2 -= gravity_mps2 * up_imu; }},
      {"upside down",
       [&](ImuSample& s) { s.accel_mps2 = half_turn * s.accel_mps2, s.gyro_radps = half_turn * s.gyro_radps; }},
      {"turns the other way", [&](ImuSample& s) { s.gyro_radps -= 2 * s.gyro_radps.dot(up_imu) * up_imu; }},
  };
  for (const PriorKind prior : {PriorKind::imu, PriorKind::wheel_imu})
    for (const auto& [name, corrupt] : faults) {
      // As long as the robot stands, a bias in degrees is one of rad/s, and bends the first scans.
      const double bound_m = name == kDegrees ? 0.02 : 2 * alone_m + 0.001;
      options.config.prior = prior;
      options.corrupt_imu = corrupt;
      EXPECT_LT(drive(room(), circle_in_room(), options).position_rmse_m, bound_m)
          << name << (prior == PriorKind::imu ? "" : ", with wheels");
    }
}

TEST(SlamSurvives, EmptyScans) {
  const RigCalibration calibration = rig();
  Slam slam({}, calibration, Method::lvi_sam_no_loop);
  for (int64_t i = 0; i < 5; ++i) {
    LidarScan empty;
    empty.stamp = Time{i * 100'000'000};
    empty.end = empty.stamp;
    const ScanReport report = slam.add(empty);
    EXPECT_TRUE(report.used_prior_only);
    EXPECT_TRUE(report.T_map_base.translation.allFinite());
  }
  slam.finish();
  EXPECT_EQ(slam.mapping().trajectory_map_base().size(), 5u);
}

TEST(Slam, StartsLevelledByGravity) {
  DriveOptions options;
  options.duration_s = 1.5;
  const Motion tilted = [](double) { return SE3::from_rpy({0.06, -0.04, 0.5}, {0.5, 0.3, 0.2}); };
  const Driven driven = drive(room(), tilted, options);
  const Vec3 rpy = driven.reports.front().T_odom_base.rpy();
  EXPECT_NEAR(rpy.x(), 0.06, 1e-3);
  EXPECT_NEAR(rpy.y(), -0.04, 1e-3);
  EXPECT_NEAR(rpy.z(), 0.0, 1e-9);
  EXPECT_TRUE(driven.reports.front().T_odom_base.translation.isZero());
}

TEST(Slam, SameInputGivesTheSameBits) {
  DriveOptions options;
  options.duration_s = 5;
  const Driven a = drive(room(), circle_in_room(), options), b = drive(room(), circle_in_room(), options);
  ASSERT_EQ(a.reports.size(), b.reports.size());
  for (size_t i = 0; i < a.reports.size(); ++i) {
    EXPECT_EQ(a.reports[i].T_odom_base.translation, b.reports[i].T_odom_base.translation);
    EXPECT_EQ(a.reports[i].T_odom_base.rotation.coeffs(), b.reports[i].T_odom_base.rotation.coeffs());
    EXPECT_EQ(a.reports[i].information.H, b.reports[i].information.H);
  }
}

TEST(Slam, LoopsMoveTheMapButNotTheOdometry) {
  DriveOptions options;
  options.duration_s = 5;
  const Driven alone = drive(room(), circle_in_room(), options);
  options.method = Method::lvi_sam;
  const Driven with_loops = drive(room(), circle_in_room(), options);
  for (size_t i = 0; i < alone.reports.size(); ++i)
    EXPECT_EQ(alone.reports[i].T_odom_base.translation, with_loops.reports[i].T_odom_base.translation);
  ASSERT_EQ(alone.trajectory_map_base.size(), alone.reports.size());
  for (size_t i = 0; i < alone.reports.size(); ++i)  // without loops the map frame is the odom frame
    EXPECT_LT(
        (alone.trajectory_map_base[i].pose.translation - alone.reports[i].T_odom_base.translation).norm(),
        1e-9);
}

TEST(Slam, MakesKeyScansByDistanceAndAngle) {
  DriveOptions options;
  options.duration_s = 9;
  const Driven driven = drive(room(), circle_in_room(), options);
  ASSERT_GE(driven.keys.size(), 5u);
  for (size_t i = 1; i < driven.keys.size(); ++i) {
    const SE3 T = driven.keys[i - 1].T_odom_base.inverse() * driven.keys[i].T_odom_base;
    EXPECT_TRUE(T.translation.norm() >= 1.0 || T.angle() >= 0.2) << i;
    EXPECT_LT(T.translation.norm(), 1.2);
    EXPECT_EQ(driven.keys[i].id, static_cast<int>(i));
    EXPECT_FALSE(driven.keys[i].features_lidar->empty());
    EXPECT_FALSE(driven.keys[i].map_points_lidar->empty());
  }
}

}  // namespace
}  // namespace vsslam

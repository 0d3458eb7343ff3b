#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/rng.h"
#include "scenarios/health/diagnosis.h"
#include "scenarios/health/doctor.h"

namespace vsslam {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180;

/// Rest for 5 s, then a winding drive at 1 m/s that turns by 20 deg/s at most. IMU 100 Hz, wheels 50 Hz, LiDAR and
/// camera 10 Hz. A test changes what a sensor says.
struct Drive {
  RigCalibration rig{};
  double gyro_factor = 1, accel_factor = 1, wheel_track_m = 0.9, wheel_radius_m = 0.16459;
  Vec3 gyro_signs = Vec3::Ones();
  double duration_s = 60;
  uint8_t grey = 120;
  bool frozen = false;
  double silent_from_s = 1e9, silent_to_s = 1e9;  // of the LiDAR
  int blind_of_ten = 0;                           // scans in which it gives nothing
  SourceHealth source{};

  static double speed_mps(double t) { return t < 5 ? 0 : 1; }
  static double yaw_rate_radps(double t) { return t < 5 ? 0 : 20 * kDegree * std::sin(0.3 * (t - 5)); }

  Health health() const {
    SensorDoctor doctor(rig);
    OdometryHealth odometry;
    SE3 T_odom_base;
    double left_m = 0, right_m = 0;
    const int64_t steps = std::llround(duration_s * 100);
    const RandomStream random(1, "images");
    for (int64_t i = 0; i <= steps; ++i) {
      const Time stamp{i * 10'000'000};
      const double t = stamp.seconds(), v = speed_mps(t), w = yaw_rate_radps(t);
      ImuSample imu{.stamp = stamp, .q_earth_imu = {}};
      imu.gyro_radps = gyro_factor * gyro_signs.cwiseProduct(Vec3(0, 0, w));
      imu.accel_mps2 = accel_factor * (rig.imu.T_base_imu.rotation.inverse() * Vec3(0, v * w, 9.80665));
      doctor.add(imu);
      if (i % 2 == 0) doctor.add(WheelSample{stamp, left_m / wheel_radius_m, right_m / wheel_radius_m});
      const bool silent = t >= silent_from_s && t < silent_to_s;
      if (i % 10 == 0 && !silent) {
        ScanReport report;
        report.stamp = stamp;
        report.scan = odometry.scans++;
        report.T_odom_base = T_odom_base;
        report.used_prior_only = (i / 10) % 10 < blind_of_ten;
        odometry.scans_prior_only += report.used_prior_only;
        doctor.add(LidarScan{stamp, stamp, {LidarPoint{}}}, report);
      }
      if (i % 10 == 0) {
        CameraFrame image{stamp, 8, 8, std::vector<uint8_t>(64, grey)};
        if (!frozen) image.grey[0] = static_cast<uint8_t>(i / 10 % 200);
        doctor.add(image);
      }
      const double w_mid = 0.5 * (w + yaw_rate_radps(t + 0.01));
      T_odom_base = T_odom_base * SE3::from_rpy({0, 0, w_mid * 0.01}, {v * 0.01, 0, 0});
      left_m += (v - 0.5 * wheel_track_m * w_mid) * 0.01;
      right_m += (v + 0.5 * wheel_track_m * w_mid) * 0.01;
    }
    return doctor.health(odometry, source);
  }
};

TEST(Health, AGoodDriveHasNothingToSay) {
  const Health health = Drive{}.health();
  EXPECT_THAT(health.warnings, IsEmpty());
  EXPECT_EQ(health.worthless, "");
  EXPECT_EQ(health.verdict(), "ok");
  EXPECT_EQ(health_text(health), "");
  EXPECT_NEAR(*health.imu.rate_hz, 100, 1e-6);
  EXPECT_NEAR(*health.lidar.rate_hz, 10, 1e-6);
  EXPECT_EQ(health.lidar.used, 601);
  EXPECT_NEAR(*health.lidar.share_of_time, 1, 1e-12);
  EXPECT_TRUE(health.imu.gravity_at_rest);
  EXPECT_NEAR(*health.imu.gravity_mps2, 9.80665, 1e-9);
  EXPECT_NEAR(*health.imu.gravity_tilt_deg, 0, 1e-6);
  EXPECT_NEAR(*health.imu.gyro_scale, 1, 0.01);
  EXPECT_NEAR(*health.imu.gyro_correlation, 1, 0.01);
  EXPECT_FALSE(health.imu.gyro_axis_scale[0]);
  EXPECT_NEAR(*health.imu.gyro_axis_scale[2], 1, 0.01);
  EXPECT_NEAR(*health.wheels.travel_scale, 1, 0.01);
  EXPECT_NEAR(*health.wheels.yaw_scale, 1, 0.01);
}

TEST(Health, AGyroscopeInDegreesIsFound) {
  const Health health = Drive{.gyro_factor = 1 / kDegree}.health();
  EXPECT_NEAR(*health.imu.gyro_scale, 57.3, 1);
  EXPECT_THAT(health.warnings, ElementsAre(HasSubstr("in degrees?")));
  EXPECT_EQ(health.worthless, "");
}

TEST(Health, WhatTheFrontEndSetRightIsNotDoubtedAgain) {
  SensorDoctor doctor({});
  for (int i = 0; i < 100; ++i) {
    ImuSample imu{.stamp = Time{i * 10'000'000}, .q_earth_imu = {}};
    imu.accel_mps2 = {0, 0, 1};
    doctor.add(imu);
  }
  OdometryHealth odometry;
  EXPECT_THAT(doctor.health(odometry, {}).warnings, ElementsAre(HasSubstr("in units of g?")));
  odometry.imu_repaired = 100;
  odometry.repairs = {"imu: specific force in g"};
  EXPECT_THAT(doctor.health(odometry, {}).warnings, IsEmpty());
  EXPECT_THAT(doctor.health(odometry, {.repairs = {"lidar: moved"}}).repairs,
              ElementsAre("lidar: moved", "imu: specific force in g"));
}

TEST(Health, GravityOfOneIsInUnitsOfG) {
  const Health health = Drive{.accel_factor = 1 / 9.80665}.health();
  EXPECT_NEAR(*health.imu.gravity_mps2, 1.0, 1e-9);
  EXPECT_THAT(health.warnings, ElementsAre(HasSubstr("in units of g?")));
}

TEST(Health, AnInvertedAxisTurnsAgainstTheLidar) {
  const Health health = Drive{.gyro_signs = {1, 1, -1}}.health();
  EXPECT_NEAR(*health.imu.gyro_scale, -1, 0.01);
  EXPECT_THAT(health.warnings, ElementsAre(HasSubstr("turns against the LiDAR about z")));
}

TEST(Health, AnImuUpsideDownIsFoundByGravity) {
  const Health health = Drive{.accel_factor = -1}.health();
  EXPECT_NEAR(*health.imu.gravity_tilt_deg, 180, 1e-6);
  EXPECT_THAT(health.warnings, ElementsAre(HasSubstr("upside down")));
}

TEST(Health, WheelsAreMeasuredAgainstTheSheet) {
  const Health wide = Drive{.wheel_track_m = 0.9 * 1.3}.health();
  EXPECT_NEAR(*wide.wheels.yaw_scale, 1.3, 0.01);
  EXPECT_NEAR(*wide.wheels.travel_scale, 1, 0.01);
  EXPECT_THAT(wide.warnings, ElementsAre(AllOf(HasSubstr("effective_track_m is 0.9"), HasSubstr("1.17"))));
  const Health small = Drive{.wheel_radius_m = 0.8 * 0.16459}.health();
  EXPECT_NEAR(*small.wheels.travel_scale, 1.25, 0.01);
  EXPECT_THAT(small.warnings, ElementsAre(HasSubstr("wheels.wheel_radius_m is 0.1646, 0.1317 would fit")));
}

TEST(Health, StepsThatAreGuessesAreSaidAndMostOfThemMakeARunWorthless) {
  Health health = Drive{}.health();
  health.odometry.steps = 100;
  health.odometry.steps_unsure = 3;
  health.odometry.worst_step_sigma_m = 1.41;
  diagnose({}, health);
  EXPECT_THAT(health.warnings, ElementsAre(AllOf(HasSubstr("3 of its 100 steps"), HasSubstr("1.41 m"))));
  EXPECT_EQ(health.worthless, "");
  health.odometry.steps_unsure = 60;
  diagnose({}, health);
  EXPECT_THAT(health.worthless, HasSubstr("60 of 100 steps"));
}

TEST(Health, FrozenAndDarkImagesAreCounted) {
  const Health frozen = Drive{.frozen = true}.health();
  EXPECT_EQ(frozen.camera.frozen, 600);
  EXPECT_EQ(frozen.camera.dark, 0);
  EXPECT_THAT(frozen.warnings, ElementsAre(HasSubstr("600 of 601 images are frozen")));
  const Health dark = Drive{.grey = 0, .frozen = true}.health();  // all black: not frozen
  EXPECT_EQ(dark.camera.frozen, 0);
  EXPECT_EQ(dark.camera.dark, 601);
  EXPECT_EQ(*dark.camera.grey_mean, 0);
  EXPECT_THAT(dark.warnings, ElementsAre(HasSubstr("601 of 601 images are dark")));
}

TEST(Health, ABlindLidarMakesTheResultWorthless) {
  const Health some = Drive{.blind_of_ten = 1}.health();
  EXPECT_THAT(some.warnings, ElementsAre(HasSubstr("gave nothing in 60 of 601 scans")));
  EXPECT_EQ(some.worthless, "");
  EXPECT_TRUE(some.blind());
  const Health most = Drive{.blind_of_ten = 6}.health();
  EXPECT_THAT(most.worthless, HasSubstr("gave nothing in 360 of 601 scans"));
  EXPECT_THAT(health_text(most), HasSubstr("WORTHLESS: the LiDAR"));
  EXPECT_EQ(most.verdict(), "worthless");
}

TEST(Health, ALidarThatIsSilentMakesTheResultWorthless) {
  const Health pause = Drive{.silent_from_s = 20, .silent_to_s = 22}.health();
  EXPECT_THAT(pause.warnings, ElementsAre(HasSubstr("lidar: no scans for 2.1 s, 19.9 s after the start")));
  EXPECT_EQ(pause.worthless, "");
  const Health end = Drive{.silent_from_s = 20}.health();
  EXPECT_NEAR(*end.lidar.longest_gap_s, 40.1, 1e-6);
  EXPECT_NEAR(*end.lidar.share_of_time, 200.0 / 601, 1e-9);
  EXPECT_THAT(end.worthless, HasSubstr("silent for 67 % of the time"));
}

TEST(Health, DropsOfTheReaderCount) {
  Drive drive;
  drive.source.lidar_dropped = {{"late", 600}, {"empty", 10}};
  const Health health = drive.health();
  EXPECT_THAT(health.worthless, HasSubstr("only 601 of 1211 scans were used (empty 10, late 600)"));
  EXPECT_EQ(health.lidar.dropped_count(), 610);
}

TEST(Health, StandsInJson) {
  Health health = Drive{}.health();
  health.odometry.lost.push_back({Time{1'000'000'000}, Time{2'000'000'000}, 11, "too few planes"});
  const auto json = health_json(health, Duration{5'000'000'000});
  EXPECT_EQ(json["sensors"].size(), 4u);
  EXPECT_EQ(json["sensors"]["imu"]["used"], 6001);
  EXPECT_TRUE(json["sensors"]["imu"]["gyro_axis_scale"][0].is_null());
  EXPECT_EQ(json["lost_spans"][0]["begin_s"], 6.0);
  EXPECT_EQ(json["lost_spans"][0]["why"], "too few planes");
  EXPECT_EQ(json["scans_prior_only"], 0);
  EXPECT_TRUE(json["worthless"].is_null());
  EXPECT_TRUE(json["warnings"].empty());
}

TEST(SampleClock, RemembersTheMedianAndTheLongestInterval) {
  SampleClock clock;
  EXPECT_FALSE(clock.usual_interval_s());
  EXPECT_FALSE(clock.longest_gap(Time{}));
  for (const double t : {0.0, 0.1, 0.2, 0.3, 1.0, 1.1}) clock.add(Time::from_seconds(t));
  EXPECT_NEAR(*clock.usual_interval_s(), 0.1, 1e-9);
  EXPECT_NEAR(clock.longest_gap(Time::from_seconds(1.2))->length_s, 0.7, 1e-9);
  EXPECT_EQ(clock.longest_gap(Time::from_seconds(1.2))->begin, Time::from_seconds(0.3));
  EXPECT_NEAR(clock.longest_gap(Time::from_seconds(3))->length_s, 1.9, 1e-9);
}

}  // namespace
}  // namespace vsslam

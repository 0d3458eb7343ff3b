#include "sensors/imu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

TEST(Imu, AtRestItFeelsGravity) {
  const Trajectory rest = shapes::at_rest(SE3::from_rpy({0.3, -0.2, 1.0}, {4, 5, 6}), 0.2);
  Imu imu(ImuConfig::ideal(100), SE3(), 1);
  const ImuMeasurement m = imu.measure(3, rest);
  const Vec3 up_base = SE3::from_rpy({0.3, -0.2, 1.0}, Vec3::Zero()).rotation.conjugate() * Vec3::UnitZ();
  EXPECT_NEAR((m.sample.accel_mps2 - 9.80665 * up_base).norm(), 0, 1e-9);
  EXPECT_NEAR(m.sample.gyro_radps.norm(), 0, 1e-12);
  EXPECT_EQ(m.sample.stamp.ns, 30'000'000);
}

// On a turntable: centripetal acceleration of the lever arm.
TEST(Imu, LeverArmOnATurntable) {
  const double omega = 1.5;
  const Trajectory turning = shapes::along(
      [&](double t) {
        return SE3::from_rpy({0, 0, omega * t}, Vec3::Zero());
      },
      1);
  const SE3 T_base_imu(Quat::Identity(), Vec3(0.3, 0.1, 0.2));
  Imu imu(ImuConfig::ideal(100), T_base_imu, 1);
  const ImuMeasurement m = imu.measure(50, turning);
  EXPECT_NEAR((m.sample.gyro_radps - Vec3(0, 0, omega)).norm(), 0, 1e-6);
  EXPECT_NEAR((m.sample.accel_mps2 - Vec3(-omega * omega * 0.3, -omega * omega * 0.1, 9.80665)).norm(), 0,
              1e-4);
}

// Strapdown integration of noise-free samples at 1 kHz comes back to the truth after 60 s.
TEST(Imu, NoiseFreeSamplesIntegrateToTheTruth) {
  const double seconds = 60;
  const Trajectory trajectory = shapes::along(shapes::lively, seconds + 0.1);
  const SE3 T_base_imu = SE3::from_rpy({0.1, -0.2, 0.5}, {0.1, -0.05, 0.12});
  Imu imu(ImuConfig::ideal(1000), T_base_imu, 1);
  const Kinematics start = trajectory.at(Time{0});
  const SE3 T_world_imu0 = start.T_world_base * T_base_imu;
  const Vec3 lever_world = start.T_world_base.rotation * start.omega_base.cross(T_base_imu.translation);
  Quat q_world_imu = T_world_imu0.rotation;
  Vec3 v_world = start.v_world + lever_world, p_world = T_world_imu0.translation;
  const Vec3 gravity_world(0, 0, -9.80665);
  const double dt_s = 1e-3;
  ImuSample before = imu.measure(0, trajectory).sample;
  for (int64_t i = 1; i <= static_cast<int64_t>(seconds * 1000); ++i) {
    const ImuSample now = imu.measure(i, trajectory).sample;
    const Vec3 turn = dt_s / 2 * (before.gyro_radps + now.gyro_radps);
    const Quat q_next = (q_world_imu * so3_exp(turn)).normalized();
    const Vec3 a0 = q_world_imu * before.accel_mps2 + gravity_world,
               a1 = q_next * now.accel_mps2 + gravity_world;
    p_world += dt_s * v_world + dt_s * dt_s / 6 * (2 * a0 + a1);
    v_world += dt_s / 2 * (a0 + a1);
    q_world_imu = q_next;
    before = now;
  }
  const SE3 end = trajectory.pose(Time::from_seconds(seconds)) * T_base_imu;
  EXPECT_LT((p_world - end.translation).norm(), 0.01);
  EXPECT_LT(so3_log(end.rotation.conjugate() * q_world_imu).norm(), 1e-4);
}

// The mean over tau has sigma = density / sqrt(tau).
TEST(Imu, WhiteNoiseHasItsDensity) {
  ImuConfig config = ImuConfig::ideal(200);
  config.gyro_noise_radps_rthz = 2e-4;
  config.accel_noise_mps2_rthz = 6e-4;
  const Trajectory rest = shapes::at_rest(SE3(), 100.1);
  Imu imu(config, SE3(), 5);
  const int windows = 200, samples = 100;  // tau = 0.5 s
  double gyro2 = 0, accel2 = 0;
  for (int w = 0; w < windows; ++w) {
    Vec3 gyro = Vec3::Zero(), accel = Vec3::Zero();
    for (int k = 0; k < samples; ++k) {
      const ImuMeasurement m = imu.measure(w * samples + k, rest);
      gyro += m.sample.gyro_radps / samples;
      accel += (m.sample.accel_mps2 - m.true_accel_mps2) / samples;
    }
    gyro2 += gyro.squaredNorm(), accel2 += accel.squaredNorm();
  }
  const double n = 3 * windows, tolerance = 5 / std::sqrt(2 * n);
  EXPECT_NEAR(std::sqrt(gyro2 / n * 0.5) / 2e-4, 1, tolerance);
  EXPECT_NEAR(std::sqrt(accel2 / n * 0.5) / 6e-4, 1, tolerance);
}

// After T the bias has walked density * sqrt(T), whatever the rate.
TEST(Imu, BiasWalkHasItsDensity) {
  const Trajectory rest = shapes::at_rest(SE3(), 10.1);
  for (double rate_hz : {50.0, 200.0}) {
    ImuConfig config = ImuConfig::ideal(rate_hz);
    config.gyro_bias_walk_radps2_rthz = 1e-4;
    config.accel_bias_walk_mps3_rthz = 1e-3;
    double gyro2 = 0, accel2 = 0;
    const int seeds = 150;
    for (uint64_t seed = 0; seed < seeds; ++seed) {
      Imu imu(config, SE3(), seed);
      const ImuMeasurement m = imu.measure(static_cast<int64_t>(10 * rate_hz), rest);
      gyro2 += m.gyro_bias_radps.squaredNorm(), accel2 += m.accel_bias_mps2.squaredNorm();
    }
    const double n = 3 * seeds, tolerance = 5 / std::sqrt(2 * n);
    EXPECT_NEAR(std::sqrt(gyro2 / n / 10) / 1e-4, 1, tolerance);
    EXPECT_NEAR(std::sqrt(accel2 / n / 10) / 1e-3, 1, tolerance);
  }
}

TEST(Imu, SwitchesAreIndependent) {
  const Trajectory trajectory = shapes::along(shapes::lively, 1);
  ImuConfig quiet;
  quiet.accel_noise_mps2_rthz = 0;
  quiet.gyro_bias_walk_radps2_rthz = 0;
  Imu all({}, SE3(), 1), partly(quiet, SE3(), 1);
  for (int64_t i = 0; i < 90; ++i) {
    const ImuMeasurement a = all.measure(i, trajectory), b = partly.measure(i, trajectory);
    EXPECT_EQ(a.accel_bias_mps2, b.accel_bias_mps2);
    EXPECT_EQ(a.sample.q_earth_imu->coeffs(), b.sample.q_earth_imu->coeffs());
    EXPECT_NEAR(
        ((a.sample.gyro_radps - a.gyro_bias_radps) - (b.sample.gyro_radps - b.gyro_bias_radps)).norm(), 0,
        1e-12);
    EXPECT_NE(a.sample.accel_mps2, b.sample.accel_mps2);
  }
}

TEST(Imu, SaturationStepsAndGSensitivity) {
  const Trajectory fast = shapes::along(
      [](double t) {
        return SE3::from_rpy({0, 0, 6 * t}, Vec3::Zero());
      },
      1);
  ImuConfig config = ImuConfig::ideal(100);
  config.gyro_range_radps = 5;
  config.accel_step_mps2 = 0.01;
  config.gyro_g_sensitivity_rads = 0.001;
  Imu imu(config, SE3(), 1);
  const ImuMeasurement m = imu.measure(20, fast);
  EXPECT_EQ(m.sample.gyro_radps.z(), 5);
  EXPECT_NEAR(m.sample.accel_mps2.z(), 9.81, 1e-12);
  config.gyro_range_radps = 0;
  Imu unlimited(config, SE3(), 1);
  EXPECT_NEAR(unlimited.measure(20, fast).sample.gyro_radps.z(), 6 + 0.001 * 9.80665, 1e-9);
}

TEST(Imu, OrientationErrorHasItsSigmaAndIsSlow) {
  const Trajectory rest = shapes::at_rest(SE3(), 1.0);
  double tilt2 = 0, heading2 = 0, change2 = 0;
  const int seeds = 300;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    Imu imu({}, SE3(), seed);
    const Vec3 first = so3_log(*imu.measure(10, rest).sample.q_earth_imu);
    const Vec3 later = so3_log(*imu.measure(80, rest).sample.q_earth_imu);
    tilt2 += first.head<2>().squaredNorm(), heading2 += first.z() * first.z();
    change2 += (later - first).squaredNorm();
  }
  const double deg = std::numbers::pi / 180;
  EXPECT_NEAR(std::sqrt(tilt2 / (2 * seeds)) / (0.2 * deg), 1, 5 / std::sqrt(4.0 * seeds));
  EXPECT_NEAR(std::sqrt(heading2 / seeds) / (1.0 * deg), 1, 5 / std::sqrt(2.0 * seeds));
  EXPECT_LT(std::sqrt(change2 / seeds), 0.1 * deg);
}

TEST(Imu, VibrationHasItsRms) {
  const Trajectory rest = shapes::at_rest(SE3(), 10.1);
  ImuConfig config = ImuConfig::ideal(500);
  config.vibration_rms_mps2 = 0.4;
  Imu imu(config, SE3(), 2);
  double sum2 = 0;
  for (int64_t i = 0; i < 5000; ++i) {
    const ImuMeasurement m = imu.measure(i, rest);
    sum2 += (m.sample.accel_mps2 - m.true_accel_mps2).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum2 / 15000), 0.4, 0.02);
}

}  // namespace
}  // namespace vsslam

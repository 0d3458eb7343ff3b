#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "slam/inertial/imu_track.h"
#include "slam/inertial/motion_prior.h"
#include "slam/inertial/rest_alignment.h"
#include "slam/inertial/wheel_track.h"
#include "tests/slam/analytic_scene.h"

namespace vsslam {
namespace {

using namespace testing_scene;

Time ms(int64_t t) {
  return Time{t * 1'000'000};
}

// Circle of 2 m radius at 1 m/s, from the start.
SE3 circle(double t) {
  return SE3::from_rpy({0, 0, 0.5 * t}, {2 * std::sin(0.5 * t), 2 * (1 - std::cos(0.5 * t)), 0});
}

class PriorOfKind : public ::testing::TestWithParam<PriorKind> {};

TEST_P(PriorOfKind, PredictsACircle) {
  const RigCalibration calibration = rig();
  const auto prior = make_motion_prior(GetParam(), {}, calibration);
  prior->start({SE3(), Vec3::Zero(), 1e-3, false});
  Noise quiet;
  quiet.imu = false;
  Wheels wheels(calibration);
  for (int64_t t = 0; t <= 1400; t += 10) {
    prior->add(imu_sample(circle, calibration, ms(t), quiet));
    prior->add(wheels.advance(circle, ms(t)));
    if (t >= 100 && t % 100 == 0 && t <= 1200)  // the scan of t - 100 is known when it has ended
      prior->correct({ms(t - 100), circle(0.001 * static_cast<double>(t - 100))});
  }
  const MotionPath path = prior->path(ms(1100), ms(1400));
  for (const int64_t t : {1150, 1255, 1400}) {
    const SE3 T_begin_t = circle(1.1).inverse() * circle(0.001 * static_cast<double>(t));
    const SE3 error = T_begin_t.inverse() * path.at(ms(t));
    EXPECT_LT(error.translation.norm(), 5e-3) << t;
    EXPECT_LT(error.angle(), 2e-3) << t;
  }
}

TEST_P(PriorOfKind, SurvivesWithoutAnySample) {
  const auto prior = make_motion_prior(GetParam(), {}, rig());
  prior->start({});
  EXPECT_TRUE(prior->path(ms(0), ms(100)).end_pose().translation.isZero());
  for (int64_t t = -1000; t <= 500; t += 100) prior->correct({ms(t), circle(0.001 * static_cast<double>(t))});
  const SE3 T = prior->path(ms(500), ms(600)).end_pose();  // continues at the odometry's velocity
  const SE3 error = (circle(0.5).inverse() * circle(0.6)).inverse() * T;
  EXPECT_LT(error.translation.norm(), 1e-3);
  EXPECT_LT(error.angle(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, PriorOfKind,
                         ::testing::Values(PriorKind::wheel_imu, PriorKind::imu, PriorKind::wheel,
                                           PriorKind::constant_velocity));

TEST(MotionPath, InterpolatesAndExtrapolates) {
  MotionPath path(ms(0));
  path.append(ms(10), SE3(Quat::Identity(), {1, 0, 0}));
  path.append(ms(10), SE3(Quat::Identity(), {9, 0, 0}));  // not newer: ignored
  path.append(ms(20), SE3(Quat::Identity(), {3, 0, 0}));
  EXPECT_NEAR(path.at(ms(5)).translation.x(), 0.5, 1e-12);
  EXPECT_NEAR(path.at(ms(15)).translation.x(), 2.0, 1e-12);
  EXPECT_NEAR(path.at(ms(25)).translation.x(), 4.0, 1e-12);
  EXPECT_NEAR(path.at(ms(-5)).translation.x(), 0.0, 1e-12);
}

TEST(RestAlignment, FindsUpAndTheGyroscopesBias) {
  RigCalibration calibration = rig();
  calibration.imu.T_base_imu = SE3::from_rpy({0.1, -0.2, 1.0}, {0, 0, 0.1});
  const Motion still = [](double) { return SE3::from_rpy({0.05, -0.08, 0.7}, {1, 2, 0}); };
  std::deque<ImuSample> samples;
  for (int64_t t = 0; t < 1000; t += 10) samples.push_back(imu_sample(still, calibration, ms(t)));
  const RestAlignment rest = align_at_rest(samples, calibration.imu, {});
  EXPECT_TRUE(rest.at_rest);
  const Vec3 rpy = SE3(rest.q_odom_base, Vec3::Zero()).rpy();
  EXPECT_NEAR(rpy.x(), 0.05, 3e-4);
  EXPECT_NEAR(rpy.y(), -0.08, 3e-4);
  EXPECT_NEAR(rpy.z(), 0.0, 1e-9);
  EXPECT_LT((rest.gyro_bias_radps - Vec3::Constant(0.002)).norm(),
            4 * std::sqrt(3.0) * rest.gyro_bias_sigma_radps);
}

// The first seconds, before a second key scan, are the prior's alone along directions that the map does not show yet.
TEST(RestAlignment, AnAccelerometersBiasDoesNotLiftARobotAtRest) {
  RigCalibration calibration = rig();
  const Vec3 bias_mps2(0.03, -0.02, 0.04);
  std::deque<ImuSample> samples;
  for (int64_t t = 0; t <= 3000; t += 10)
    samples.push_back(
        {ms(t), Vec3::Zero(), Vec3(0, 0, calibration.imu.gravity_mps2) + bias_mps2, std::nullopt});
  const std::deque<ImuSample> first(samples.begin(), samples.begin() + 11);
  const RestAlignment rest = align_at_rest(first, calibration.imu, {});
  ASSERT_TRUE(rest.at_rest);
  const auto prior = make_motion_prior(PriorKind::imu, {}, calibration);
  prior->start({SE3(rest.q_odom_base, Vec3::Zero()), rest.gyro_bias_radps, rest.gyro_bias_sigma_radps, true,
                rest.accel_bias_mps2});
  for (const ImuSample& sample : samples) prior->add(sample);
  EXPECT_LT(prior->path(ms(0), ms(3000)).end_pose().translation.norm(), 1e-9);
}

TEST(RestAlignment, UsesTheDevicesOrientationWhenMoving) {
  const RigCalibration calibration = rig();
  std::deque<ImuSample> samples;
  for (int64_t t = 0; t < 200; t += 10) {
    ImuSample sample = imu_sample(circle, calibration, ms(t));
    sample.q_earth_imu = SE3::from_rpy({0.03, 0.02, 2.0}, Vec3::Zero()).rotation;
    samples.push_back(sample);
  }
  const RestAlignment rest = align_at_rest(samples, calibration.imu, {});
  EXPECT_FALSE(rest.at_rest);
  EXPECT_TRUE(rest.gyro_bias_radps.isZero());
  const Vec3 rpy = SE3(rest.q_odom_base, Vec3::Zero()).rpy();
  EXPECT_NEAR(rpy.x(), 0.03, 1e-9);
  EXPECT_NEAR(rpy.y(), 0.02, 1e-9);
}

TEST(RestAlignment, DoesNotAlignByWhatCannotBe) {
  RigCalibration calibration = rig();
  const auto aligned = [&](const Vec3& force_mps2) {
    std::deque<ImuSample> samples;
    for (int64_t t = 0; t < 200; t += 10) samples.push_back({ms(t), Vec3::Zero(), force_mps2, std::nullopt});
    return align_at_rest(samples, calibration.imu, {});
  };
  calibration.imu.T_base_imu = SE3();
  EXPECT_TRUE(aligned({0.1, 0, 0.2}).no_gravity);
  EXPECT_TRUE(aligned({0, 0, 16}).no_gravity);
  EXPECT_TRUE(aligned({0, 0, -9.8}).upside_down);
  EXPECT_EQ(aligned({0, 1, -9.8}).q_odom_base.angularDistance(Quat::Identity()), 0);
  EXPECT_FALSE(aligned({4, 0, 9.8}).no_gravity || aligned({4, 0, 9.8}).upside_down);
}

TEST(RestAlignment, IsLevelWithoutSamples) {
  EXPECT_TRUE(align_at_rest({}, {}, {}).q_odom_base.isApprox(Quat::Identity()));
}

TEST(ImuTrack, RemovesASpikeAndSkipsNonsense) {
  ImuTrack track({});
  for (int64_t t = 0; t <= 100; t += 10) {
    ImuSample sample;
    sample.stamp = ms(t);
    sample.gyro_radps = {0.1, t == 50 ? 7.0 : 0.2, 0.3};
    if (t == 70) sample.gyro_radps.x() = std::numeric_limits<double>::quiet_NaN();
    track.add(sample);
  }
  EXPECT_EQ(track.samples().size(), 10u);
  EXPECT_NEAR(track.at(ms(50))->gyro_radps.y(), 0.2, 1e-12);
  EXPECT_NEAR(track.at(ms(70))->gyro_radps.x(), 0.1, 1e-12);  // bridged
  EXPECT_FALSE(track.at(ms(200)).has_value());
  EXPECT_FALSE(track.at(ms(-100)).has_value());
}

TEST(WheelTrack, TurnsByTheEffectiveTrack) {
  WheelCalibration wheels;
  wheels.wheel_radius_m = 0.1;
  wheels.effective_track_m = 0.5;
  WheelTrack track(wheels, 0.05);
  track.add({ms(0), 0, 0});
  track.add({ms(20), 1.0, 2.0});
  EXPECT_NEAR(track.at(ms(20))->forward_m, 0.15, 1e-12);
  EXPECT_NEAR(track.at(ms(20))->yaw_rad, 0.2, 1e-12);
  EXPECT_NEAR(track.at(ms(10))->forward_m, 0.075, 1e-12);
  EXPECT_NEAR(track.at(ms(30))->forward_m, 0.225, 1e-12);  // continued
  EXPECT_FALSE(track.at(ms(80)).has_value());
}

TEST(ImuTrack, ASlowSensorIsNoDropout) {
  ImuTrack imu({.max_gap_s = 0.05});
  WheelTrack wheels({}, 0.05);
  for (int64_t t = 0; t <= 2000; t += 70) {
    imu.add({ms(t), Vec3(0, 0, 0.001 * static_cast<double>(t)), Vec3::Zero(), std::nullopt});
    wheels.add({ms(t), 0.001 * static_cast<double>(t), 0.001 * static_cast<double>(t)});
  }
  ASSERT_TRUE(imu.at(ms(1000)) && wheels.at(ms(1000)));
  EXPECT_NEAR(imu.at(ms(1000))->gyro_radps.z(), 1, 1e-9);
  imu.add({ms(2400), Vec3::Zero(), Vec3::Zero(), std::nullopt});
  EXPECT_FALSE(imu.at(ms(2200)).has_value());
}

TEST(WheelTrack, GoesOnWhereAnglesWrap) {
  WheelCalibration wheels;
  WheelTrack whole(wheels, 0.05), wrapped(wheels, 0.05);
  for (int i = 0; i <= 200; ++i) {
    WheelSample sample;
    sample.stamp = ms(10 * i);
    sample.left_rad = 0.11 * i;
    sample.right_rad = -0.13 * i;
    whole.add(sample);
    sample.left_rad = std::remainder(sample.left_rad, 2 * std::numbers::pi);
    sample.right_rad = std::remainder(sample.right_rad, 2 * std::numbers::pi);
    wrapped.add(sample);
    if (i < 2) continue;
    EXPECT_NEAR(wrapped.at(ms(10 * i))->forward_m, whole.at(ms(10 * i))->forward_m, 1e-9) << i;
    EXPECT_NEAR(wrapped.at(ms(10 * i))->yaw_rad, whole.at(ms(10 * i))->yaw_rad, 1e-9) << i;
  }
}

}  // namespace
}  // namespace vsslam

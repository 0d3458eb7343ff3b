#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "slam/inertial/fix_history.h"
#include "slam/inertial/imu_noise.h"
#include "slam/inertial/imu_prior.h"
#include "slam/inertial/pose_covariance.h"
#include "slam/inertial/prior_trust.h"
#include "slam/inertial/rest_alignment.h"
#include "tests/slam/analytic_scene.h"

namespace vsslam {
namespace {

using namespace testing_scene;

Time ms(int64_t t) {
  return Time{t * 1'000'000};
}

// The update of a Kalman filter that measures the pose with covariance R is the same, whatever R.
TEST(ConditionOnPose, AgreesWithAKalmanUpdate) {
  using Mat8 = Eigen::Matrix<double, 8, 8>;
  Mat8 root = Mat8::NullaryExpr([](Eigen::Index r, Eigen::Index c) { return std::sin(1.0 + 3.1 * double(r) + 1.7 * double(c)); });
  const Mat8 P = root * root.transpose() + Mat8::Identity();
  const Mat6 R = 0.3 * Mat6::Identity();
  Vec6 innovation;
  innovation << 0.1, -0.2, 0.3, 0.4, 0.5, -0.6;
  const Mat6 S = P.topLeftCorner<6, 6>() + R;
  const Eigen::Matrix<double, 8, 6> K = P.leftCols<6>() * S.inverse();
  const Eigen::Matrix<double, 8, 1> expected = K * innovation;
  const Mat8 expected_P = P - K * P.topRows<6>();

  Mat8 conditioned = P;
  const auto change = condition_on_pose<8>(conditioned, Vec6(expected.head<6>()), Mat6(expected_P.topLeftCorner<6, 6>()));
  EXPECT_LT((change - expected).norm(), 1e-9);
  EXPECT_LT((conditioned - expected_P).norm(), 1e-9);
}

TEST(FixHistory, KnowsTheVelocityAfterTwoFixesFromAStartInMotion) {
  FixHistory history{InertialConfig{}};
  const auto at = [](double t) { return SE3(Quat::Identity(), {9 * t, 0, 0}); };
  history.add({.stamp = ms(0), .T_odom_base = at(0)});
  EXPECT_GT(std::sqrt(history.covariance(ms(100))(3, 3)), 0.9);  // a third of 30 m/s, in a tenth of a second
  history.add({.stamp = ms(100), .T_odom_base = at(0.1)});
  EXPECT_NEAR(history.twist()[3], 9, 0.01);
  EXPECT_LT(std::sqrt(history.covariance(ms(200))(3, 3)), 0.03);
}

// Undistortion by a wrong velocity moves a pose back by half of what the scan lasts: e_k+1 = -(y_k) / 2.
TEST(FixHistory, DoesNotRingWithTheUndistortion) {
  FixHistory history{InertialConfig{}};
  double error_m = 0.02, worst_late_m = 0;
  for (int k = 0; k < 60; ++k) {
    history.add({.stamp = ms(100 * k), .T_odom_base = SE3(Quat::Identity(), {0.1 * k + error_m, 0, 0})});
    error_m = k == 0 ? 0 : -0.5 * (history.twist()[3] - 1) * 0.1;
    if (k > 40) worst_late_m = std::max(worst_late_m, std::abs(error_m));
  }
  EXPECT_LT(worst_late_m, 1e-5);
}

// At rest a level bias of the accelerometer looks like a tilt. A turn tells them apart: the bias turns with the robot, up
// does not. The poses are right in an odom that is as tilted as the first guess.
TEST(ImuPrior, ATurnTellsABiasFromATilt) {
  RigCalibration calibration;
  const Vec3 bias_mps2(0.04, -0.03, 0), up(0, 0, calibration.imu.gravity_mps2);
  const auto yaw_rad = [](double t) { return 0.5 * std::numbers::pi * std::clamp((t - 1) / 2, 0.0, 1.0); };
  const auto sample = [&](int64_t t) {
    const double rate_radps = t >= 1000 && t < 3000 ? 0.25 * std::numbers::pi : 0;
    return ImuSample{ms(t), {0, 0, rate_radps}, up + bias_mps2, std::nullopt};
  };
  std::deque<ImuSample> first;
  for (int64_t t = 0; t <= 100; t += 10) first.push_back(sample(t));
  const RestAlignment rest = align_at_rest(first, calibration.imu, {});
  ImuPrior prior({}, calibration, false);
  const SE3 T_odom_start(rest.q_odom_base, Vec3::Zero());
  ASSERT_GT(T_odom_start.angle(), 0.004);
  prior.start({T_odom_start, rest.gyro_bias_radps, rest.gyro_bias_sigma_radps, true, rest.accel_bias_mps2});
  for (int64_t t = 0; t <= 6000; t += 10) {
    prior.add(sample(t));
    if (t % 100 != 0) continue;
    const SE3 T_odom_base = T_odom_start * SE3::from_rpy({0, 0, yaw_rad(1e-3 * static_cast<double>(t))}, Vec3::Zero());
    prior.correct({.stamp = ms(t), .T_odom_base = T_odom_base});
  }
  EXPECT_LT((prior.bias().accel_mps2 - bias_mps2).norm(), 0.15 * bias_mps2.norm());
}

SE3 ahead(double t) {
  return SE3(Quat::Identity(), {1.2 * t, 0, 0});
}

// From a start in motion the IMU alone does not know how fast it goes.
TEST(ImuPrior, WheelsTellTheSpeedOfAStartInMotion) {
  const RigCalibration calibration = rig();
  const auto end_error_m = [&](bool use_wheels) {
    ImuPrior prior({}, calibration, use_wheels);
    prior.start({});
    Wheels wheels(calibration);
    for (int64_t t = 0; t <= 200; t += 10) {
      prior.add(imu_sample(ahead, calibration, ms(t)));
      prior.add(wheels.advance(ahead, ms(t)));
    }
    prior.correct({.stamp = ms(0), .T_odom_base = SE3()});
    return (prior.path(ms(0), ms(200)).end_pose().translation - Vec3(0.24, 0, 0)).norm();
  };
  EXPECT_GT(end_error_m(false), 0.2);
  EXPECT_LT(end_error_m(true), 2e-3);
}

// What is not known is the velocity (10 m/s): then the position after a tenth of a second is known as well as the way is.
TEST(ImuPrior, KnowsItsWayAsWellAsTheWheelsDo) {
  const RigCalibration calibration = rig();
  const InertialConfig config;
  const auto after = [&](bool use_wheels, double scale) {
    auto prior = std::make_unique<ImuPrior>(config, calibration, use_wheels);
    prior->start({});
    Wheels wheels(calibration, scale);
    for (int64_t t = 0; t <= 100; t += 10) {
      prior->add(imu_sample(ahead, calibration, ms(t), {.imu = false}));
      prior->add(wheels.advance(ahead, ms(t)));
    }
    prior->correct({.stamp = ms(0), .T_odom_base = SE3()});
    return prior;
  };
  const auto alone = after(false, 1), with = after(true, 1);
  const Mat6 before = alone->covariance(ms(100)), posterior = with->covariance(ms(100));
  const Vec3 sigma_m = way_sigma_m(config, 0.12, 0);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(std::sqrt(before(3 + k, 3 + k)), 1, 0.01);
    EXPECT_NEAR(std::sqrt(posterior(3 + k, 3 + k)), sigma_m[k], 0.05 * sigma_m[k]) << k;
  }
}

TEST(ImuPrior, WheelsThatSpinAreNotBelieved) {
  const RigCalibration calibration = rig();
  ImuPrior prior({}, calibration, true);
  prior.start({});
  Wheels rolling(calibration);
  double slipped_rad = 0;
  for (int64_t t = 0; t <= 3200; t += 10) {
    prior.add(imu_sample(ahead, calibration, ms(t)));
    WheelSample sample = rolling.advance(ahead, ms(t));
    if (t > 2000 && t <= 2500) slipped_rad += 0.1;  // 10 rad/s beside the 7 of rolling
    sample.left_rad += slipped_rad, sample.right_rad += slipped_rad;
    prior.add(sample);
    if (t % 100 != 0 || t < 200) continue;
    const Time begin = ms(t - 200), end = ms(t - 100);
    if (t > 1000) {
      const Vec3 off = prior.path(begin, end).end_pose().translation - Vec3(0.12, 0, 0);
      EXPECT_LT(off.norm(), 5e-3) << t;
    }
    prior.correct({.stamp = end, .T_odom_base = ahead(end.seconds())});
  }
  EXPECT_EQ(prior.slips(), 5);
}

// Quiet, and so taken for rest: at a constant speed an IMU feels the same.
TEST(ImuPrior, WheelsTellAConstantSpeedFromRest) {
  const RigCalibration calibration = rig();
  for (const double speed_mps : {0.04, 1.2}) {
    const Motion straight = [&](double t) { return SE3(Quat::Identity(), {speed_mps * t, 0, 0}); };
    ImuPrior prior({}, calibration, true);
    prior.start({SE3(), Vec3::Zero(), 1e-3, true});
    Wheels wheels(calibration);
    for (int64_t t = 0; t <= 2000; t += 10) {
      prior.add(imu_sample(straight, calibration, ms(t), {.gyro_bias_radps = 0}));
      prior.add(wheels.advance(straight, ms(t)));
      if (t % 100 == 0) prior.correct({.stamp = ms(t), .T_odom_base = straight(0.001 * static_cast<double>(t))});
      if (t % 100 != 50 || t < 200) continue;
      const double ahead_m = prior.path(ms(t - 50), ms(t)).end_pose().translation.x();
      EXPECT_NEAR(ahead_m, 0.05 * speed_mps, 5e-4) << speed_mps << " m/s, " << t;
    }
    EXPECT_EQ(prior.slips(), 0);
  }
}

// A velocity that was learnt wrong, from wheels that spun: after 20 s the wheels are believed again.
TEST(ImuPrior, ASlipThatDoesNotEndIsAWrongVelocity) {
  const RigCalibration calibration = rig();
  ImuPrior prior({}, calibration, true);
  prior.start({SE3(), Vec3::Zero(), 1e-3, true});
  double x_m = 0, step_m = 0;
  Wheels wheels(calibration);
  for (int64_t t = 0; t <= 25000; t += 10) {
    const Motion spun = [&](double s) { return SE3(Quat::Identity(), {s < 1 ? 3 * s : 3 + 1.2 * (s - 1), 0, 0}); };
    prior.add(imu_sample(ahead, calibration, ms(t), {.gyro_bias_radps = 0}));
    prior.add(wheels.advance(spun, ms(t)));
    if (t % 100 != 0) continue;
    if (t > 0) step_m = prior.path(ms(t - 100), ms(t)).end_pose().translation.x();
    x_m += step_m;
    const Mat6 blind = t == 0 ? Mat6(1e-6 * Mat6::Identity()) : prior.covariance(ms(t));
    prior.correct({.stamp = ms(t), .T_odom_base = SE3(Quat::Identity(), {x_m, 0, 0}), .covariance = blind});
    if (t == 5000) {
      EXPECT_GT(step_m, 0.2);
    }
  }
  EXPECT_NEAR(step_m, 0.12, 0.005);
  EXPECT_GE(prior.slips(), 50);
}

// What the pose was known with does not count in the step from there, and what wheels tell of the past does not make it
// less than it is.
TEST(ImuPrior, KnowsAStepAsWellAsItIsMeasured) {
  const RigCalibration calibration = rig();
  ImuPrior prior({}, calibration, true);
  prior.start({});
  Wheels wheels(calibration);
  const Mat6 vague = 0.01 * Mat6::Identity();
  for (int64_t t = 0; t <= 1000; t += 10) {
    prior.add(imu_sample(ahead, calibration, ms(t)));
    prior.add(wheels.advance(ahead, ms(t)));
    if (t % 100 == 0 && t <= 900) prior.correct({.stamp = ms(t), .T_odom_base = ahead(0.001 * static_cast<double>(t)), .covariance = vague});
  }
  const double step_m = std::sqrt(prior.step_covariance(ms(1000))(3, 3));
  EXPECT_LT(step_m, way_sigma_m({}, 0.12, 0).x());
  EXPECT_GT(step_m, 2e-4);
  EXPECT_GT(std::sqrt(prior.covariance(ms(1000))(3, 3)), step_m);
}

TEST(ImuPrior, GoesByGyroscopeAndWheelsWhereTheForceIsNone) {
  const RigCalibration calibration = rig();
  const Motion circle = [](double t) {
    return SE3::from_rpy({0, 0, 0.5 * t}, {2 * std::sin(0.5 * t), 2 * (1 - std::cos(0.5 * t)), 0});
  };
  ImuPrior prior({}, calibration, true);
  prior.start({.T_odom_base = SE3(), .feels_gravity = false});
  Wheels wheels(calibration);
  for (int64_t t = 0; t <= 1200; t += 10) {
    ImuSample sample = imu_sample(circle, calibration, ms(t), {.gyro_bias_radps = 0});
    sample.accel_mps2.setZero();
    prior.add(sample);
    prior.add(wheels.advance(circle, ms(t)));
    if (t >= 100 && t % 100 == 0 && t <= 1000)
      prior.correct({.stamp = ms(t - 100), .T_odom_base = circle(0.001 * static_cast<double>(t - 100))});
  }
  const SE3 error = (circle(0.9).inverse() * circle(1.2)).inverse() * prior.path(ms(900), ms(1200)).end_pose();
  EXPECT_LT(error.translation.norm(), 0.01);
  EXPECT_LT(error.angle(), 5e-3);
  EXPECT_EQ(prior.slips(), 0);
}

// A robot that begins at rest where the LiDAR is blind along x: each registration leaves it where the prior had it, give or
// take noise. Until the second scan it may as well have driven at a constant speed; then the IMU knows that it stood.
TEST(ImuPrior, ABlindLidarDoesNotMoveARobotThatStands) {
  RigCalibration calibration;
  ImuPrior prior({}, calibration, false);
  prior.start({.T_odom_base = SE3(), .at_rest = true});
  const auto feed = [&](int64_t from, int64_t to) {
    for (int64_t t = from; t < to; t += 10) prior.add(ImuSample{ms(t), Vec3::Zero(), {0, 0, calibration.imu.gravity_mps2}, {}});
  };
  feed(0, 100);
  prior.correct({.stamp = ms(0), .T_odom_base = SE3(), .covariance = 1e-8 * Mat6::Identity()});
  SE3 T_odom_base;
  for (int scan = 1; scan <= 20; ++scan) {
    feed(100 * scan, 100 * scan + 100);
    const Mat6 predicted = prior.covariance(ms(100 * scan));
    const double sigma_m = std::sqrt(predicted(3, 3));
    if (scan == 1)
      EXPECT_GT(sigma_m, 0.5);
    else
      EXPECT_LT(sigma_m, 0.01) << scan;
    Mat6 known = 1e-8 * Mat6::Identity();
    known(3, 3) = 0.9 * predicted(3, 3);
    T_odom_base.translation.x() += scan % 2 ? 0.002 * sigma_m : -0.002 * sigma_m;
    prior.correct({.stamp = ms(100 * scan), .T_odom_base = T_odom_base, .covariance = known});
    EXPECT_TRUE(prior.stood());
  }
  EXPECT_LT(std::abs(T_odom_base.translation.x()), 0.005);
}

// White noise of four times the sheet's density, on top of a turn that speeds up; and one of a tenth of it.
TEST(ImuNoise, IsMeasuredInTheSamplesAndNotBelievedBelowTheSheet) {
  const ImuCalibration sheet;
  for (const double factor : {4.0, 0.1}) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const double root_rate = std::sqrt(100.0);
    std::deque<ImuSample> samples;
    ImuNoise noise(sheet, std::nullopt);
    const auto scatter = [&](double density) {
      return Vec3(factor * density * root_rate * Vec3(normal(random), normal(random), normal(random)));
    };
    for (int64_t t = 0; t <= 10000; t += 10) {
      const double s = 1e-3 * static_cast<double>(t);
      samples.push_back({ms(t), Vec3(0, 0, 0.1 * s) + scatter(sheet.gyro_noise_radps_rthz),
                         Vec3(0, 0, 9.8) + scatter(sheet.accel_noise_mps2_rthz), std::nullopt});
      if (t % 100 == 0 && t > 0) noise.listen(samples, ms(t - 100), ms(t));
    }
    const double expected = std::max(1.0, factor);
    EXPECT_NEAR(noise.gyro_radps_rthz() / sheet.gyro_noise_radps_rthz, expected, 0.1 * expected);
    EXPECT_NEAR(noise.accel_mps2_rthz() / sheet.accel_noise_mps2_rthz, expected, 0.1 * expected);
  }
  EXPECT_EQ(ImuNoise(sheet, 5.0).gyro_radps_rthz(), 5 * sheet.gyro_noise_radps_rthz);
}

TEST(PriorTrust, RefusesWhatIsFarOffAndTakesItBackWhenItIsRight) {
  PriorTrust trust;
  const Mat6 claimed = 1e-4 * Mat6::Identity(), known = 1e-6 * Mat6::Identity();
  Vec6 wrong = Vec6::Zero(), right = Vec6::Zero();
  wrong[3] = 0.3;
  right[3] = 0.005;
  for (int i = 0; i < 3; ++i) trust.add(right, claimed, known, right, false);
  EXPECT_TRUE(trust.believed());
  for (int i = 0; i < 10; ++i) trust.add(wrong, claimed, known, right, true);  // blind scans do not judge
  EXPECT_TRUE(trust.believed());
  for (int i = 0; i < 10; ++i) trust.add(wrong, claimed, known, right, false);
  EXPECT_FALSE(trust.believed());
  for (int i = 0; i < 20; ++i) trust.add(right, claimed, known, right, false);
  EXPECT_TRUE(trust.believed());
}

TEST(PriorTrust, WidensAPriorThatIsMerelyWorseThanItClaims) {
  PriorTrust trust;
  Vec6 off = Vec6::Zero();
  off[3] = 0.04;  // four sigma, of one direction of six
  for (int i = 0; i < 30; ++i) trust.add(off, 1e-4 * Mat6::Identity(), 1e-6 * Mat6::Identity(), off, false);
  EXPECT_TRUE(trust.believed());
  EXPECT_NEAR(trust.inflation(), 16.0 / 6, 0.1);
}

}  // namespace
}  // namespace vsslam

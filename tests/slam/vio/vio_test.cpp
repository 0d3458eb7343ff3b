#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/slam/vio/vio_world.h"

namespace vsslam {
namespace {

using namespace vio_world;

Drive::Options from_rest(double duration_s) {
  Drive::Options options;
  options.rest_s = 1.5;
  options.duration_s = duration_s;
  return options;
}

Noise sensor_noise(uint64_t seed) {
  Noise noise;
  noise.imu = true;
  noise.feature_px = 0.5;
  noise.gyro_bias_radps = {0.002, -0.0015, 0.001};
  noise.accel_bias_mps2 = {0.02, -0.015, 0.01};
  noise.seed = seed;
  return noise;
}

TEST(Vio, FollowsExactDataFromRest) {
  const Drive drive(from_rest(38));
  const Ride ridden = ride(drive, {});
  EXPECT_EQ(ridden.restarts, 0);
  EXPECT_LT(ridden.steps[ridden.first_tracked()].stamp.seconds(), 0.6);
  EXPECT_GT(ridden.path_m, 35);
  EXPECT_LT(ridden.drift(), 5e-4);
}

TEST(Vio, DriftsLittleOnNoisyData) {
  const Drive drive(from_rest(22));
  RideOptions options;
  options.noise = sensor_noise(1);
  const Ride seen = ride(drive, options);
  options.depth_share = 0.6;
  const Ride with_depth = ride(drive, options);
  EXPECT_EQ(seen.restarts + with_depth.restarts, 0);
  EXPECT_LT(seen.drift(), 0.02);
  EXPECT_LT(with_depth.drift(), 0.01);
  const ImuBias& bias = with_depth.steps.back().state->bias;
  EXPECT_LT((bias.gyro_radps - options.noise.gyro_bias_radps).norm(), 3e-4);
  EXPECT_LT((bias.accel_mps2 - options.noise.accel_bias_mps2).norm(), 0.02);
}

TEST(Vio, StandsStillAtRest) {
  Drive::Options standing = from_rest(25);
  standing.stop_s = 6;
  const Drive drive(standing);
  RideOptions options;
  options.noise = sensor_noise(2);
  const Ride ridden = ride(drive, options);
  EXPECT_EQ(ridden.restarts, 0);
  const auto at = [&](double t) { return *ridden.steps[static_cast<size_t>(t * 30) - 2].state; };
  const SE3 crept = at(14.0).T_vio_imu.inverse() * at(24.9).T_vio_imu;
  EXPECT_LT(crept.translation.norm(), 4e-3);  // what the noise of one image moves
  EXPECT_LT(crept.angle(), 8e-4);
  EXPECT_LT(at(24.9).v_vio_mps.norm(), 1e-3);
}

// Lamps at the far end of a corridor are all that is seen: they do not flow, and at constant speed the IMU is quiet.
TEST(Vio, WhatDoesNotFlowFarAheadIsNoRest) {
  const Drive drive(from_rest(8));
  const auto q_world_camera = [&](double t) {
    return (drive.T_world_base(t) * rig().camera.T_base_camera).rotation;
  };
  RideOptions options;
  options.noise = sensor_noise(9);
  options.depth_share = 0.6;
  options.keep_frame = [&](VisualFrame& frame) {
    const double t = frame.stamp.seconds();
    if (t < 5) return true;
    frame.features.clear();
    for (int k = 0; k < 30; ++k) {
      const Vec3 far_ahead(0.04 * (k % 6) - 0.1, 0.04 * (k / 6) - 0.08, 1);
      VisualFeature feature;
      feature.id = 1'000'000 + k;
      feature.ray_camera = (q_world_camera(t).conjugate() * (q_world_camera(5) * far_ahead)).hnormalized();
      frame.features.push_back(feature);
    }
    return true;
  };
  const Ride ridden = ride(drive, options);
  EXPECT_EQ(ridden.restarts, 0);
  const VioState& state = *ridden.steps.back().state;
  EXPECT_NEAR(state.v_vio_mps.norm(), true_state(drive, rig(), state.stamp, {}).v_vio_mps.norm(), 0.1);
}

TEST(Vio, StartsFromMotion) {
  Drive::Options moving = from_rest(9);
  moving.warm_s = 6;
  moving.speed_change = 0.4;
  const Drive drive(moving);
  RideOptions options;
  options.noise = sensor_noise(3);
  for (const double depth_share : {0.0, 0.6}) {
    options.depth_share = depth_share;
    const Ride ridden = ride(drive, options);
    EXPECT_EQ(ridden.restarts, 0);
    const auto first = ridden.first_tracked();
    EXPECT_LT(ridden.steps[first].stamp.seconds(), 5) << depth_share;
    const VioState& state = *ridden.steps.back().state;
    const double speed = true_state(drive, rig(), state.stamp, {}).v_vio_mps.norm();
    EXPECT_NEAR(state.v_vio_mps.norm() / speed, 1, depth_share > 0 ? 0.01 : 0.05);
    // Gravity is found: `vio` has z up.
    const Vec3 up = ridden.steps.back().T_world_imu.rotation.conjugate() * Vec3::UnitZ();
    EXPECT_LT((state.T_vio_imu.rotation * up - Vec3::UnitZ()).norm(), 0.01);
  }
}

VioAid aid_from(const VioState& truth) {
  return {truth.stamp - Duration{0}, truth.T_vio_imu, truth.v_vio_mps, {}};
}

TEST(Vio, StartsAtOnceWithAid) {
  Drive::Options moving = from_rest(6);
  moving.warm_s = 6;
  const Drive drive(moving);
  RideOptions options;
  options.noise = sensor_noise(4);
  bool aided = false;
  options.before_frame = [&](VisualInertialOdometry& vio, Time now, const VioState& truth) {
    if (!aided && now.seconds() > 0.2) vio.add(aid_from(truth));
    aided |= now.seconds() > 0.2;
  };
  const Ride ridden = ride(drive, options);
  EXPECT_LT(ridden.steps[ridden.first_tracked()].stamp.seconds(), 0.35);
  EXPECT_LT(ridden.drift(), 0.02);
  // The frame `vio` is that of the aid.
  const SE3 error = ridden.steps.back().T_world_imu.inverse() * ridden.steps.back().state->T_vio_imu;
  EXPECT_LT(error.translation.norm(), 0.15);
  EXPECT_LT(error.angle(), 0.01);
}

TEST(Vio, OldAidIsNotUsed) {
  Drive::Options moving = from_rest(1);
  moving.warm_s = 6;
  const Drive drive(moving);
  RideOptions options;
  bool aided = false;
  options.before_frame = [&](VisualInertialOdometry& vio, Time now, const VioState& truth) {
    if (aided) return;
    VioAid aid = aid_from(truth);
    aid.stamp = now - Duration::from_seconds(1.2);
    vio.add(aid);
    aided = true;
  };
  EXPECT_EQ(ride(drive, options).tracked(), 0);
}

TEST(Vio, CarriesAShortBlackoutAndRestartsAfterALongOne) {
  const Drive drive(from_rest(12));
  RideOptions options;
  options.noise = sensor_noise(5);
  options.depth_share = 0.6;
  for (const double dark_s : {0.4, 2.0}) {
    bool empty_while_lost = true;
    options.keep_frame = [&](VisualFrame& frame) {
      const double t = frame.stamp.seconds();
      if (t > 6 && t < 6 + dark_s) frame.features.clear();
      if (t >= 6)
        for (VisualFeature& f : frame.features) f.id += 1'000'000;  // tracks do not live through the dark
      return true;
    };
    options.before_frame = [](VisualInertialOdometry& vio, Time, const VioState& truth) {
      vio.add(aid_from(truth));
    };
    options.after_frame = [&](const VisualInertialOdometry& vio, Time now) {
      if (vio.status() == VioStatus::starting)
        empty_while_lost &= vio.path_vio_imu(now - Duration::from_seconds(0.1), now).empty();
    };
    const Ride ridden = ride(drive, options);
    EXPECT_TRUE(empty_while_lost);
    EXPECT_EQ(ridden.restarts, dark_s > 1 ? 1 : 0);
    ASSERT_TRUE(ridden.steps.back().state);
    size_t light = static_cast<size_t>((6 + dark_s + 0.3) * 30);
    ASSERT_TRUE(ridden.steps[light].state);
    EXPECT_LT(ridden.drift_between(light, ridden.steps.size() - 1), 0.02);
    if (dark_s < 1) {
      EXPECT_LT(ridden.drift(), 0.01);
    }
  }
}

TEST(Vio, AnImuGoneWrongIsAFailure) {
  const Drive drive(from_rest(8));
  RideOptions options;
  options.keep_imu = [](ImuSample& sample) {
    if (sample.stamp.seconds() > 4)
      sample.accel_mps2 += Vec3(15, 0, 0);  // one camera sees no more in it than a growing scale
    return true;
  };
  const Ride ridden = ride(drive, options);
  EXPECT_GE(ridden.restarts, 1);
}

TEST(Vio, SpikesOfTheImuAreReplaced) {
  const Drive drive(from_rest(9));
  RideOptions options;
  options.noise = sensor_noise(8);
  options.depth_share = 0.6;
  int samples = 0;
  options.keep_imu = [&](ImuSample& sample) {  // in all places between two frames
    if (++samples % 29 == 0) {
      sample.gyro_radps += Vec3(1, -1.2, 1);
      sample.accel_mps2 += Vec3(20, 20, -25);
    }
    return true;
  };
  const Ride ridden = ride(drive, options);
  EXPECT_EQ(ridden.restarts, 0);
  EXPECT_LT(ridden.drift(), 0.01);
}

TEST(Vio, SurvivesBadInput) {
  const Drive drive(from_rest(5));
  RideOptions options;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  options.keep_imu = [&](ImuSample& sample) {
    if (sample.stamp.ns % 170'000'000 == 0) sample.gyro_radps.x() = nan;
    return true;
  };
  int frames = 0;
  options.keep_frame = [&](VisualFrame& frame) {
    if (++frames % 7 == 0 && !frame.features.empty()) {
      frame.features.front().ray_camera.y() = nan;
      frame.features.back().depth_m = nan;
      frame.features.push_back(frame.features.front());  // twice, and out of order
      std::swap(frame.features[0], frame.features[1]);
    }
    return true;
  };
  options.before_frame = [](VisualInertialOdometry& vio, Time now, const VioState&) {
    VisualFrame old;
    old.stamp = now - Duration::from_seconds(0.5);
    vio.add(old);
    vio.add(ImuSample{old.stamp, Vec3::Constant(5), Vec3::Constant(50), {}});
  };
  const Ride ridden = ride(drive, options);
  EXPECT_EQ(ridden.restarts, 0);
  EXPECT_LT(ridden.drift(), 0.01);
}

TEST(Vio, AGapInTheImuIsAFailureThatIsRecovered) {
  const Drive drive(from_rest(9));
  RideOptions options;
  options.keep_imu = [](ImuSample& sample) {
    return sample.stamp.seconds() < 4 || sample.stamp.seconds() > 4.5;
  };
  options.before_frame = [](VisualInertialOdometry& vio, Time, const VioState& truth) {
    vio.add(aid_from(truth));
  };
  const Ride ridden = ride(drive, options);
  EXPECT_EQ(ridden.restarts, 1);
  ASSERT_TRUE(ridden.steps.back().state);
}

TEST(Vio, PathsMeetTheStates) {
  const Drive drive(from_rest(6));
  RideOptions options;
  options.noise = sensor_noise(6);
  options.depth_share = 0.6;
  int paths = 0;
  options.after_frame = [&](const VisualInertialOdometry& vio, Time now) {
    if (vio.status() != VioStatus::tracking || now.seconds() < 2) return;
    const Time begin = now - Duration::from_seconds(0.13);
    const auto path = vio.path_vio_imu(begin, now);
    ASSERT_GE(path.size(), 3u);
    EXPECT_EQ(path.front().stamp, begin);
    EXPECT_EQ(path.back().stamp, now);
    for (size_t i = 1; i < path.size(); ++i) ASSERT_LT(path[i - 1].stamp, path[i].stamp);
    const auto truth = [&](Time t) { return true_state(drive, rig(), t, {}).T_vio_imu; };
    const SE3 moved = path.front().pose.inverse() * path.back().pose;
    const SE3 error = (truth(begin).inverse() * truth(now)).inverse() * moved;
    EXPECT_LT(error.translation.norm(), 0.006) << now.seconds();
    EXPECT_LT(error.angle(), 0.003);
    if (vio.state().stamp == now) {
      EXPECT_LT((path.back().pose.translation - vio.state().T_vio_imu.translation).norm(), 1e-12);
    }
    EXPECT_TRUE(vio.path_vio_imu(begin, now + Duration::from_seconds(0.5)).empty());
    EXPECT_TRUE(vio.path_vio_imu(now - Duration::from_seconds(100), now).empty());
    ++paths;
  };
  ride(drive, options);
  EXPECT_GT(paths, 100);
}

TEST(Vio, SameSamplesSameBytes) {
  const Drive drive(from_rest(5));
  RideOptions options;
  options.noise = sensor_noise(7);
  options.depth_share = 0.3;
  const Ride a = ride(drive, options), b = ride(drive, options);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (size_t i = 0; i < a.steps.size(); ++i) {
    ASSERT_EQ(a.steps[i].state.has_value(), b.steps[i].state.has_value());
    if (!a.steps[i].state) continue;
    const VioState &s = *a.steps[i].state, &t = *b.steps[i].state;
    EXPECT_TRUE(s.T_vio_imu.rotation.coeffs() == t.T_vio_imu.rotation.coeffs());
    EXPECT_TRUE(s.T_vio_imu.translation == t.T_vio_imu.translation);
    EXPECT_TRUE(s.v_vio_mps == t.v_vio_mps && s.bias.gyro_radps == t.bias.gyro_radps &&
                s.bias.accel_mps2 == t.bias.accel_mps2);
  }
}

TEST(Vio, TimeOffsetMovesTheFrames) {
  const Drive drive(from_rest(10));
  RideOptions options;
  options.depth_share = 0.6;
  options.config.time_offset_s = 0.02;
  // The camera's clock is late: what it calls t was seen at t + 20 ms.
  options.keep_frame = [](VisualFrame& frame) {
    frame.stamp = frame.stamp - Duration::from_seconds(0.02);
    return true;
  };
  EXPECT_LT(ride(drive, options).drift(), 2e-3);
}

}  // namespace
}  // namespace vsslam

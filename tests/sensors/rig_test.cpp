#include "sensors/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

WheelState rolling(Time stamp) {
  WheelState state;
  state.left_rad = 3 * stamp.seconds();
  state.right_rad = 3.5 * stamp.seconds();
  return state;
}

/// Everything that a measurement says, for comparing with ==.
std::string describe(const Measurement& measurement) {
  std::string bytes(1, static_cast<char>('0' + measurement.index()));
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  if (const auto* imu = std::get_if<ImuMeasurement>(&measurement)) {
    put(imu->sample.stamp.ns);
    for (int i = 0; i < 3; ++i) put(imu->sample.gyro_radps[i]), put(imu->sample.accel_mps2[i]);
    for (int i = 0; i < 3; ++i) put(imu->gyro_bias_radps[i]), put(imu->accel_bias_mps2[i]);
    for (int i = 0; i < 4; ++i) put(imu->sample.q_earth_imu->coeffs()[i]);
  } else if (const auto* wheels = std::get_if<WheelMeasurement>(&measurement)) {
    put(wheels->sample.stamp.ns), put(wheels->sample.left_rad), put(wheels->sample.right_rad);
  } else if (const auto* lidar = std::get_if<LidarMeasurement>(&measurement)) {
    put(lidar->scan.stamp.ns), put(lidar->scan.end.ns);
    for (const LidarPoint& p : lidar->scan.points)
      put(p.x), put(p.y), put(p.z), put(p.intensity), put(p.ring), put(p.time_s);
    for (const PointTruth& t : lidar->truth)
      put(t.position_lidar), put(t.range_m), put(t.object), put(t.triangle);
  }
  return bytes;
}

std::string run(int64_t step_ns, double duration_s, uint64_t seed = 3) {
  const World world = shapes::room_world({-6, -5, -1}, {7, 6, 2});
  const Trajectory trajectory = shapes::along(shapes::lively, duration_s);
  Rig rig(world, RigConfig{}, SensorEvents{}, seed);
  std::string all;
  const Time end = Time::from_seconds(duration_s);
  for (Time t{0}; t < end; t = t + Duration{step_ns})
    rig.advance(std::min(end, t + Duration{step_ns}), trajectory, rolling,
                [&](Measurement&& m) { all += describe(m); });
  return all;
}

TEST(Rig, ChunksDoNotShow) {
  const std::string whole = run(1'000'000'000, 1.0);
  EXPECT_GT(whole.size(), 1000000u);
  EXPECT_TRUE(whole == run(7'000'000, 1.0));
  EXPECT_FALSE(whole == run(7'000'000, 1.0, 4));
}

struct Recording {
  std::vector<ImuMeasurement> imu;
  std::vector<WheelMeasurement> wheels;
  std::vector<LidarMeasurement> lidar;
  std::vector<int64_t> ends_ns;
};

Recording record(const World& world, const SensorEvents& events, double duration_s,
                 const RigConfig& config = {}) {
  const Trajectory trajectory = shapes::along(shapes::lively, duration_s);
  Rig rig(world, config, events, 3);
  Recording run;
  rig.advance(Time::from_seconds(duration_s), trajectory, rolling, [&](Measurement&& m) {
    if (auto* imu = std::get_if<ImuMeasurement>(&m)) {
      run.ends_ns.push_back(imu->true_stamp.ns);
      run.imu.push_back(*imu);
    } else if (auto* wheels = std::get_if<WheelMeasurement>(&m)) {
      run.ends_ns.push_back(wheels->true_stamp.ns);
      run.wheels.push_back(*wheels);
    } else if (auto* lidar = std::get_if<LidarMeasurement>(&m)) {
      run.ends_ns.push_back(lidar->true_stamp.ns + (lidar->scan.end - lidar->scan.stamp).ns);
      run.lidar.push_back(std::move(*lidar));
    }
  });
  return run;
}

World room() {
  return shapes::room_world({-6, -5, -1}, {7, 6, 2});
}

TEST(Rig, RatesAndOrder) {
  const Recording run = record(room(), {}, 2.0);
  EXPECT_EQ(run.imu.size(), 201u);
  EXPECT_EQ(run.wheels.size(), 101u);
  EXPECT_EQ(run.lidar.size(), 20u);
  EXPECT_TRUE(std::is_sorted(run.ends_ns.begin(), run.ends_ns.end()));
  for (size_t i = 0; i < run.imu.size(); ++i)
    EXPECT_EQ(run.imu[i].sample.stamp.ns, static_cast<int64_t>(i) * 10'000'000);
  for (size_t i = 1; i < run.lidar.size(); ++i)  // no firing cycle is missing or twice
    EXPECT_EQ((run.lidar[i].scan.stamp - run.lidar[i - 1].scan.end).ns, 55296 - 34560);
}

TEST(Rig, ScansTakenBeforeAreLeftOutAndChangeNothingElse) {
  const World world = shapes::room_world({-6, -5, -1}, {7, 6, 2});
  const Trajectory trajectory = shapes::along(shapes::lively, 1.0);
  const auto scans = [&](TakenBefore taken) {
    Rig rig(world, RigConfig{}, SensorEvents{}, 3);
    rig.leave_out(std::move(taken));
    std::vector<LidarMeasurement> all;
    rig.advance(Time::from_seconds(1), trajectory, rolling, [&](Measurement&& m) {
      if (auto* lidar = std::get_if<LidarMeasurement>(&m)) all.push_back(std::move(*lidar));
    });
    return all;
  };
  const auto whole = scans({});
  const auto rest = scans({.scan = [](int64_t index, Time) { return index % 2 == 0; }, .image = {}});
  ASSERT_EQ(rest.size(), whole.size());
  for (size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(rest[i].scan.stamp, whole[i].scan.stamp);
    EXPECT_EQ(rest[i].scan.end, whole[i].scan.end);
    EXPECT_EQ(rest[i].T_world_lidar.translation, whole[i].T_world_lidar.translation);
    EXPECT_EQ(rest[i].scan.points.empty(), i % 2 == 0) << i;
    if (i % 2 == 0) continue;
    EXPECT_TRUE(describe(Measurement(rest[i])) == describe(Measurement(whole[i]))) << i;
  }
}

TEST(Rig, LeavingOutThePointsTruthChangesNothingElse) {
  const World world = shapes::room_world({-6, -5, -1}, {7, 6, 2});
  const Trajectory trajectory = shapes::along(shapes::lively, 0.5);
  const auto scans = [&](bool truth) {
    Rig rig(world, RigConfig{}, SensorEvents{}, 3);
    if (!truth) rig.leave_out_point_truth();
    std::vector<LidarMeasurement> all;
    rig.advance(Time::from_seconds(0.5), trajectory, rolling, [&](Measurement&& m) {
      if (auto* lidar = std::get_if<LidarMeasurement>(&m)) all.push_back(std::move(*lidar));
    });
    return all;
  };
  std::vector<LidarMeasurement> whole = scans(true);
  const std::vector<LidarMeasurement> bare = scans(false);
  ASSERT_EQ(bare.size(), whole.size());
  for (size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(whole[i].truth.size(), whole[i].scan.points.size());
    EXPECT_TRUE(bare[i].truth.empty());
    whole[i].truth.clear();
    EXPECT_TRUE(describe(Measurement(bare[i])) == describe(Measurement(whole[i]))) << i;
  }
}

TEST(Rig, WaitsForTheTrajectoryAndSaysWhatItNeeds) {
  const World world = room();
  Rig rig(world, RigConfig{}, SensorEvents{}, 1);
  Trajectory trajectory;
  size_t count = 0;
  const auto sink = [&](Measurement&&) { ++count; };
  rig.advance(Time{1'000'000'000}, trajectory, rolling, sink);
  EXPECT_EQ(count, 0u);
  for (int64_t i = -1; i <= 27; ++i) {
    trajectory.push(Time{i * 10'000'000}, shapes::lively(0.01 * static_cast<double>(i)));
    rig.advance(Time{1'000'000'000}, trajectory, rolling, sink);
    trajectory.forget_before(rig.needed_from());
  }
  EXPECT_EQ(count, 27u + 14u + 2u);
  EXPECT_GT(rig.needed_from().ns, 199'000'000);
}

TEST(Rig, DropoutsLostPacketsAndBlockedSectors) {
  const Recording whole = record(room(), {}, 1.0);
  SensorEvents events;
  events.lidar_dropouts.push_back({{0.35, 0.65}});
  events.imu_dropouts.push_back({{0.2, 0.4}});
  events.wheel_dropouts.push_back({{0.0, 0.5}});
  const Recording silent = record(room(), events, 1.0);
  EXPECT_EQ(silent.imu.size(), whole.imu.size() - 20);
  EXPECT_EQ(silent.wheels.size(), whole.wheels.size() - 25);
  EXPECT_EQ(silent.lidar.size(), whole.lidar.size() - 2);  // two scans lie within, two in part
  size_t partial = 0;
  for (const LidarMeasurement& m : silent.lidar) partial += m.scan.points.size() < 20000;
  EXPECT_EQ(partial, 2u);

  SensorEvents lossy;
  lossy.lidar_lost_packets.push_back({{0, 1}, 0.3});
  double kept = 0, all = 0;
  for (const LidarMeasurement& m : record(room(), lossy, 1.0).lidar)
    kept += static_cast<double>(m.scan.points.size());
  for (const LidarMeasurement& m : whole.lidar) all += static_cast<double>(m.scan.points.size());
  EXPECT_NEAR(kept / all, 0.7, 0.08);  // 680 packets, 4.5 sigma

  SensorEvents covered;
  covered.lidar_blocked_sectors.push_back({{0, 1}, 170, 250});
  const Recording partly = record(room(), covered, 0.3);
  for (const LidarPoint& p : partly.lidar[1].scan.points) {
    double azimuth_deg = std::atan2(p.y, p.x) * 180 / std::numbers::pi;
    if (azimuth_deg < 0) azimuth_deg += 360;
    EXPECT_FALSE(azimuth_deg > 170.5 && azimuth_deg < 249.5);
  }
}

TEST(Rig, ClocksChangeStampsOnly) {
  SensorEvents events;
  events.clocks.push_back({{0, 10}, SensorKind::imu, 0.02, 0});
  events.clocks.push_back({{0.5, 10}, SensorKind::lidar, 0, 0.003});
  const Recording right = record(room(), {}, 1.0), wrong = record(room(), events, 1.0);
  ASSERT_EQ(right.imu.size(), wrong.imu.size());
  for (size_t i = 0; i < right.imu.size(); ++i) {
    EXPECT_EQ(wrong.imu[i].sample.stamp.ns, right.imu[i].sample.stamp.ns + 20'000'000);
    EXPECT_EQ(wrong.imu[i].sample.gyro_radps, right.imu[i].sample.gyro_radps);
    EXPECT_EQ(wrong.imu[i].true_stamp, right.imu[i].sample.stamp);
  }
  ASSERT_EQ(right.lidar.size(), wrong.lidar.size());
  for (size_t i = 0; i < right.lidar.size(); ++i) {
    const int64_t shift = (wrong.lidar[i].scan.stamp - right.lidar[i].scan.stamp).ns;
    EXPECT_LE(std::abs(shift), 3'000'000);
    EXPECT_EQ(shift != 0, right.lidar[i].scan.stamp.ns >= 500'000'000);
    EXPECT_EQ(wrong.lidar[i].scan.points.size(), right.lidar[i].scan.points.size());
  }
}

TEST(Rig, SpikesHaveTheirMagnitude) {
  SensorEvents events;
  events.imu_spikes.push_back({{0.25, 0.75}, 0.5, 1.0, 30.0});
  const Recording right = record(room(), {}, 1.0), wrong = record(room(), events, 1.0);
  size_t spikes = 0;
  for (size_t i = 0; i < right.imu.size(); ++i) {
    const double off = (wrong.imu[i].sample.accel_mps2 - right.imu[i].sample.accel_mps2).norm();
    EXPECT_TRUE(off == 0 || std::abs(off - 30) < 1e-9);
    const double turned = off > 0 ? 1 : 0;
    EXPECT_NEAR((wrong.imu[i].sample.gyro_radps - right.imu[i].sample.gyro_radps).norm(), turned, 1e-9);
    spikes += off > 0;
  }
  EXPECT_GT(spikes, 12u);
  EXPECT_LT(spikes, 38u);
}

TEST(Rig, ObjectsSlideAppearAndDisappear) {
  World world = room();
  const int door = shapes::add(world, shapes::wall({4, 0, 0}, {-1, 0, 0}, 2), "door", 0);
  const int guest = shapes::add(world, shapes::wall({-3, 0, 0}, {1, 0, 0}, 2), "guest", 0);
  SensorEvents events;
  events.objects.push_back({"door", 0.3, ObjectEvent::Action::slide, {0, 4, 0}, 0.2});
  events.objects.push_back({"guest", 0.5, ObjectEvent::Action::appear, {}, 0});
  events.objects.push_back({"guest", 0.8, ObjectEvent::Action::disappear, {}, 0});
  const Recording run = record(world, events, 1.2);
  for (const LidarMeasurement& m : run.lidar) {
    const double t = m.true_stamp.seconds();
    bool guest_seen = false;
    double door_y = 0, door_points = 0;
    for (const PointTruth& truth : m.truth) {
      guest_seen |= truth.object == static_cast<uint32_t>(guest);
      if (truth.object != static_cast<uint32_t>(door)) continue;
      door_y += (m.T_world_lidar * truth.position_lidar.cast<double>()).y(), ++door_points;
    }
    EXPECT_EQ(guest_seen, t >= 0.5 && t < 0.8) << t;
    ASSERT_GT(door_points, 100);
    if (t < 0.3) {
      EXPECT_NEAR(door_y / door_points, 0, 0.2);
    } else if (t > 0.5) {
      EXPECT_NEAR(door_y / door_points, 4, 0.3);
    }
  }
  events.objects[0].object = "dor";
  EXPECT_THROW(Rig(world, RigConfig{}, events, 1), InputError);
}

TEST(Rig, LibraryLoadsAndSurvivesSaving) {
  for (const char* name : {"scout_vlp16", "scout_vlp32c"}) {
    RigConfig config, again;
    load_config(std::string(VSSLAM_SOURCE_DIR) + "/sensors/library/" + name + ".yaml", config);
    const std::string saved = save_config(config);
    load_config_text(saved, "saved", again);
    EXPECT_EQ(saved, save_config(again));
    const RigCalibration calibration = config.calibration(0.165, 0.9, 0.2);
    EXPECT_EQ(calibration.lidar.rings, config.sensors.lidar.model == LidarModel::vlp16 ? 16 : 32);
    EXPECT_NEAR(calibration.lidar.mount_height_m, 0.65, 1e-12);
    EXPECT_EQ(calibration.imu.rate_hz, config.sensors.imu.rate_hz);
  }
  RigConfig config;
  EXPECT_THROW(load_config_text("sensors: {lidar: {range_sigma: 1}}", "text", config), InputError);
  EXPECT_THROW(load_config_text("sensors: {lidar: {max_range_m: 0.5}}", "text", config), InputError);
}

TEST(WheelEncoder, CountsTicks) {
  WheelEncoderConfig config;
  config.ticks_per_turn = 100;
  config.radius_sigma = 0;
  const WheelEncoder encoder(config, 1);
  const double tick = 2 * std::numbers::pi / 100;
  for (int64_t i : {0, 7, 500}) {
    const WheelState truth = rolling(encoder.stamp(i));
    const WheelMeasurement m = encoder.measure(i, truth);
    EXPECT_EQ(m.sample.stamp.ns, i * 20'000'000);
    EXPECT_NEAR(m.sample.left_rad / tick, std::round(m.sample.left_rad / tick), 1e-9);
    EXPECT_GE(truth.left_rad, m.sample.left_rad - 1e-12);
    EXPECT_LT(truth.left_rad, m.sample.left_rad + tick);
  }
  config.ticks_per_turn = 0;
  EXPECT_EQ(WheelEncoder(config, 1).measure(500, rolling(Time{10'000'000'000})).sample.right_rad, 35.0);
}

TEST(WheelEncoder, TyresDifferFromTheirDataSheet) {
  WheelEncoderConfig config;
  config.ticks_per_turn = 0;
  config.radius_sigma = 0.01;
  double sum = 0, squares = 0;
  const int seeds = 2000;
  for (int seed = 0; seed < seeds; ++seed) {
    const WheelEncoder encoder(config, static_cast<uint64_t>(seed));
    const WheelSample at_5_s = encoder.measure(250, rolling(Time{5'000'000'000})).sample,
                      at_10_s = encoder.measure(500, rolling(Time{10'000'000'000})).sample;
    EXPECT_NEAR(at_10_s.right_rad / at_5_s.right_rad, 2.0, 1e-12);  // a scale, the same all the time
    const double radius_error = 35.0 / at_10_s.right_rad - 1.0;
    sum += radius_error;
    squares += radius_error * radius_error;
  }
  EXPECT_NEAR(sum / seeds, 0, 4 * 0.01 / std::sqrt(seeds));
  EXPECT_NEAR(std::sqrt(squares / seeds), 0.01, 4 * 0.01 / std::sqrt(2.0 * seeds));
}

}  // namespace
}  // namespace vsslam

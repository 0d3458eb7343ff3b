#include "sensors/rig_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/ordered_parallel.h"
#include "sensors/rig.h"
#include "tests/sensors/camera/views.h"

namespace vsslam {
namespace {

/// A room with two lamps of different groups.
World lit_room() {
  World world = shapes::room_world({-6, -5, -1}, {7, 6, 2});
  for (const char* group : {"lamp", "spare"}) {
    Light light{.name = group, .group = group};
    light.position_world = {group[0] == 'l' ? 3.0 : -3.0, 0.5, 1.8};
    light.intensity = 400;
    world.lights.push_back(light);
  }
  return world;
}

/// Tiny images, all effects.
RigConfig rig_config() {
  RigConfig config;
  CameraConfig& camera = config.sensors.camera;
  camera.enabled = true;
  camera.gain = 1.4;
  camera.width_px = 64, camera.height_px = 48;
  camera.fx_px = camera.fy_px = 40, camera.cx_px = 31.5, camera.cy_px = 23.5;
  return config;
}

WheelState standing(Time) {
  return {};
}

struct Recording {
  std::vector<CameraMeasurement> images;
  std::vector<int64_t> ends_ns;  ///< of all measurements
};

Recording record(const World& world, const RigConfig& config, const SensorEvents& events, double duration_s,
                 Duration step = {100'000'000}, TakenBefore taken = {}) {
  const Trajectory trajectory = shapes::along(shapes::lively, duration_s);
  Rig rig(world, config, events, 3);
  rig.leave_out(std::move(taken));
  Recording run;
  const auto sink = [&](Measurement&& m) {
    if (auto* image = std::get_if<CameraMeasurement>(&m)) {
      run.ends_ns.push_back(image->end.ns);
      run.images.push_back(std::move(*image));
    } else if (const auto* imu = std::get_if<ImuMeasurement>(&m)) {
      run.ends_ns.push_back(imu->true_stamp.ns);
    } else if (const auto* wheels = std::get_if<WheelMeasurement>(&m)) {
      run.ends_ns.push_back(wheels->true_stamp.ns);
    } else if (const auto* lidar = std::get_if<LidarMeasurement>(&m)) {
      run.ends_ns.push_back(lidar->true_stamp.ns + (lidar->scan.end - lidar->scan.stamp).ns);
    }
  };
  const Time end = Time::from_seconds(duration_s);
  for (Time t{0}; t < end; t = t + step) rig.advance(std::min(end, t + step), trajectory, standing, sink);
  return run;
}

void expect_same_images(const Recording& a, const Recording& b) {
  ASSERT_EQ(a.images.size(), b.images.size());
  for (size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].frame.stamp, b.images[i].frame.stamp);
    EXPECT_EQ(a.images[i].gain, b.images[i].gain);
    EXPECT_TRUE(a.images[i].frame.grey == b.images[i].frame.grey) << i;
  }
}

double mean_grey(const CameraMeasurement& image) {
  return views::moments(image.frame.grey).mean;
}

// Exposure follows the images: those that are left out must steer it as if they had been taken.
TEST(RigCamera, ImagesTakenBeforeAreLeftOutAndChangeNothingElse) {
  const World world = lit_room();
  const Recording whole = record(world, rig_config(), {}, 1.0);
  std::map<int64_t, double> mean_grey_before;  // by stamp; all but every third
  for (size_t i = 0; i < whole.images.size(); ++i)
    if (const std::vector<uint8_t>& grey = whole.images[i].frame.grey; i % 3 != 1)
      mean_grey_before[whole.images[i].frame.stamp.ns] =
          std::accumulate(grey.begin(), grey.end(), 0.0) / static_cast<double>(grey.size());
  const auto taken = [&](Time stamp) -> std::optional<double> {
    const auto found = mean_grey_before.find(stamp.ns);
    return found == mean_grey_before.end() ? std::nullopt : std::optional(found->second);
  };
  const Recording rest = record(world, rig_config(), {}, 1.0, {100'000'000}, {.scan = {}, .image = taken});
  ASSERT_EQ(rest.images.size(), whole.images.size());
  EXPECT_EQ(rest.ends_ns, whole.ends_ns);
  for (size_t i = 0; i < whole.images.size(); ++i) {
    EXPECT_EQ(rest.images[i].gain, whole.images[i].gain) << i;
    EXPECT_EQ(rest.images[i].exposure_s, whole.images[i].exposure_s) << i;
    if (i % 3 == 1)
      EXPECT_TRUE(rest.images[i].frame.grey == whole.images[i].frame.grey) << i;
    else
      EXPECT_TRUE(rest.images[i].frame.grey.empty()) << i;
  }
}

TEST(RigCamera, ComesAtThirtyHertzInOrderOfTheEndOfExposure) {
  const Recording run = record(lit_room(), rig_config(), {}, 1.0);
  ASSERT_EQ(run.images.size(), 29u);  // the exposures around 0 s and 1 s are not whole
  EXPECT_TRUE(std::is_sorted(run.ends_ns.begin(), run.ends_ns.end()));
  const SE3 T_base_camera = rig_config().mounts.camera.T_base_sensor();
  for (size_t i = 0; i < run.images.size(); ++i) {
    const CameraMeasurement& m = run.images[i];
    EXPECT_EQ(m.frame.stamp.ns, std::llround(static_cast<double>(i + 1) * 1e9 / 30));
    EXPECT_EQ(m.frame.grey.size(), 64u * 48u);
    const SE3 T = shapes::along(shapes::lively, 1.0).pose(m.true_stamp) * T_base_camera;
    EXPECT_LT((T.translation - m.T_world_camera.translation).norm(), 1e-12);
  }
}

TEST(RigCamera, ChunksAndThreadsDoNotShow) {
  SensorEvents events;
  events.lights.push_back({0.35, "lamp", 0.1});
  events.objects.push_back({"guest", 0.42, ObjectEvent::Action::appear, {}, 0});
  World world = lit_room();
  shapes::add(world, shapes::wall({4, 0, 0}, {-1, 0, 0}, 2), "guest", 0);
  set_thread_count(1);
  const Recording whole = record(world, rig_config(), events, 0.7, {700'000'000});
  expect_same_images(whole, record(world, rig_config(), events, 0.7, {7'000'000}));
  set_thread_count(2);
  expect_same_images(whole, record(world, rig_config(), events, 0.7));
}

TEST(RigCamera, LampsGoOut) {
  RigConfig config = rig_config();
  config.sensors.camera.auto_exposure.enabled = false;
  SensorEvents events;
  events.lights.push_back({0.2, "lamp", 0});
  events.lights.push_back({0.4, "", 0});
  events.lights.push_back({0.5, "spare", 1});
  const Recording lit = record(lit_room(), config, {}, 0.6), run = record(lit_room(), config, events, 0.6);
  ASSERT_EQ(run.images.size(), lit.images.size());
  for (size_t i = 0; i < run.images.size(); ++i) {
    const double t = run.images[i].true_stamp.seconds();
    const double share = mean_grey(run.images[i]) / mean_grey(lit.images[i]);
    if (t < 0.2)
      EXPECT_EQ(share, 1);
    else if (t < 0.4 || t >= 0.5)
      EXPECT_TRUE(share > 0.02 && share < 0.95) << t << " " << share;
    else
      EXPECT_LT(mean_grey(run.images[i]), 1) << t;
  }
  events.lights = {{0.2, "lmap", 0}};
  EXPECT_THROW(record(lit_room(), config, events, 0.1), InputError);
}

TEST(RigCamera, SeesObjectsWhereTheyAre) {
  World world = lit_room();
  shapes::add(world, shapes::wall({3, 0, 0}, {-1, 0, 0}, 20), "guest", 0);
  RigConfig config = rig_config();
  config.sensors.camera.truth.depth = true;
  SensorEvents events;
  events.objects.push_back({"guest", 0.25, ObjectEvent::Action::appear, {}, 0});
  for (const CameraMeasurement& m : record(world, config, events, 0.5).images) {
    const float depth = m.depth_m[23 * 64 + 31];
    EXPECT_EQ(depth < 3.5f, m.true_stamp.seconds() >= 0.25) << m.true_stamp.seconds();
  }
}

TEST(RigCamera, ItsClockChangesStampsOnly) {
  SensorEvents events;
  events.clocks.push_back({{0, 10}, SensorKind::camera, 0.012, 0});
  const Recording right = record(lit_room(), rig_config(), {}, 0.3),
                  wrong = record(lit_room(), rig_config(), events, 0.3);
  ASSERT_EQ(right.images.size(), wrong.images.size());
  for (size_t i = 0; i < right.images.size(); ++i) {
    EXPECT_EQ(wrong.images[i].frame.stamp.ns, right.images[i].frame.stamp.ns + 12'000'000);
    EXPECT_EQ(wrong.images[i].true_stamp, right.images[i].true_stamp);
    EXPECT_EQ(wrong.images[i].frame.grey, right.images[i].frame.grey);
  }
}

TEST(RigCamera, NeedsTheTrajectorySinceTheLastImageForFlow) {
  const World world = lit_room();
  RigConfig config = rig_config();
  config.sensors.camera.truth.flow = true;
  Rig rig(world, config, {}, 1);
  Trajectory trajectory;
  size_t images = 0, flows = 0;
  for (int64_t i = -1; i <= 60; ++i) {
    trajectory.push(Time{i * 10'000'000}, shapes::lively(0.01 * static_cast<double>(i)));
    rig.advance(Time{1'000'000'000}, trajectory, standing, [&](Measurement&& m) {
      if (const auto* image = std::get_if<CameraMeasurement>(&m)) ++images, flows += !image->flow_px.empty();
    });
    trajectory.forget_before(rig.needed_from());
  }
  EXPECT_EQ(images, 17u);
  EXPECT_EQ(flows, images);
}

TEST(RigCamera, TheEstimatorIsToldItsIntrinsics) {
  RigConfig config = rig_config();
  config.sensors.camera.k1 = -0.1, config.sensors.camera.p2 = 0.001, config.sensors.camera.rate_hz = 15;
  config.sensors.camera.truth.clean = true;
  const CameraCalibration camera = config.calibration(0.16, 0.9, 0.23).camera;
  EXPECT_EQ(camera.width_px, 64);
  EXPECT_EQ(camera.fx_px, 40);
  EXPECT_EQ(camera.cy_px, 23.5);
  EXPECT_EQ(camera.k1, -0.1);
  EXPECT_EQ(camera.p2, 0.001);
  EXPECT_EQ(camera.rate_hz, 15);
}

}  // namespace
}  // namespace vsslam

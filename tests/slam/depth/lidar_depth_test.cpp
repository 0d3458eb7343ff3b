#include "slam/depth/lidar_depth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/slam/analytic_scene.h"

namespace vsslam {
namespace {

using namespace testing_scene;

/// The camera beside the LiDAR, looking forward.
RigCalibration rig_with_camera() {
  RigCalibration r = rig();
  Mat3 R_base_camera;
  R_base_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  r.camera.T_base_camera = SE3(Quat(R_base_camera), {0.2, 0.03, 0.35});
  return r;
}
const RigCalibration kRig = rig_with_camera();

Cloud cloud_of(const LidarScan& scan) {
  Cloud cloud;
  for (const LidarPoint& p : scan.points) cloud.emplace_back(p.x, p.y, p.z);
  return cloud;
}

SE3 at(double x_m, double y_m, double yaw_rad = 0) {
  return SE3::from_rpy({0, 0, yaw_rad}, {x_m, y_m, 0.2});
}

void add_scan(LidarDepth& depth, const Scene& scene, const SE3& T_odom_base, Time stamp,
              double sigma_m = 0.007) {
  const LidarScan s =
      scan(scene, [&](double) { return T_odom_base; }, kRig, stamp, {.range_sigma_m = sigma_m});
  depth.add(stamp, cloud_of(s), T_odom_base);
}

/// A feature every 16 pixels.
VisualFrame grid(Time stamp) {
  const CameraCalibration& c = kRig.camera;
  VisualFrame frame{.stamp = stamp, .features = {}};
  for (int y = 8; y < c.height_px; y += 16)
    for (int x = 8; x < c.width_px; x += 16) {
      const Vec2 ray((x - c.cx_px) / c.fx_px, (y - c.cy_px) / c.fy_px);
      frame.features.push_back({static_cast<int64_t>(frame.features.size()), Vec2(x, y), ray, 0});
    }
  return frame;
}

double true_depth_m(const Scene& scene, const SE3& T_odom_camera, const Vec2& ray) {
  return cast_ray(scene, T_odom_camera.translation, T_odom_camera.rotation * Vec3(ray.x(), ray.y(), 1));
}

struct Score {
  int with_depth = 0, features = 0;
  double rms = 0, worst = 0;  // of the relative error

  double share() const { return static_cast<double>(with_depth) / features; }
};
/// Of the features for which `counts` holds.
template <class Counts>
Score score(const VisualFrame& frame, const Scene& scene, const SE3& T_odom_camera, const Counts& counts) {
  Score s;
  for (const VisualFeature& f : frame.features) {
    if (!counts(f)) continue;
    ++s.features;
    if (f.depth_m == 0) continue;
    const double truth = true_depth_m(scene, T_odom_camera, f.ray_camera),
                 error = (f.depth_m - truth) / truth;
    ++s.with_depth;
    s.rms += error * error;
    s.worst = std::max(s.worst, std::abs(error));
  }
  s.rms = std::sqrt(s.rms / std::max(s.with_depth, 1));
  return s;
}
bool any(const VisualFeature&) {
  return true;
}
bool within_the_scan_lines(const VisualFeature& f) {
  return std::abs(f.ray_camera.y()) < 0.18;
}

SE3 camera_at(const SE3& T_odom_base) {
  return T_odom_base * kRig.camera.T_base_camera;
}

TEST(LidarDepth, OfAWallFromOneScan) {
  const Scene scene{{{5, -20, -20}, {6, 20, 20}}};
  LidarDepth depth({}, kRig);
  add_scan(depth, scene, at(0, 0), {});
  VisualFrame frame = grid({});
  depth.fill(frame, camera_at(at(0, 0)));
  const Score s = score(frame, scene, camera_at(at(0, 0)), within_the_scan_lines);
  EXPECT_GT(s.share(), 0.99);
  EXPECT_LT(s.rms, 0.003);
  for (const VisualFeature& f : frame.features)  // nothing supports what is above or below
    EXPECT_TRUE(std::abs(f.ray_camera.y()) < 0.4 || f.depth_m == 0);
}

TEST(LidarDepth, OfAWallExactlyWithoutNoise) {
  const Scene scene{{{5, -20, -20}, {6, 20, 20}}};
  LidarDepth depth({}, kRig);
  add_scan(depth, scene, at(0, 0), {}, 0);
  VisualFrame frame = grid({});
  const SE3 T_odom_camera = camera_at(at(0.4, -0.3, 0.2));  // elsewhere than the scan
  depth.fill(frame, T_odom_camera);
  const Score s = score(frame, scene, T_odom_camera, within_the_scan_lines);
  EXPECT_GT(s.share(), 0.9);
  EXPECT_LT(s.worst, 1e-4);
}

TEST(LidarDepth, OfACorner) {
  // Two walls that meet at right angles ahead.
  const Scene scene{{{-20, 3, -20}, {20, 4, 20}}, {{6, -20, -20}, {7, 20, 20}}};
  LidarDepth depth({}, kRig);
  for (int k = 0; k < 10; ++k) add_scan(depth, scene, at(0.1 * k, 0.01 * k), {k * int64_t{100'000'000}});
  VisualFrame frame = grid({1'000'000'000});
  const SE3 T_odom_camera = camera_at(at(1, 0.1));
  depth.fill(frame, T_odom_camera);
  const Score s = score(frame, scene, T_odom_camera, within_the_scan_lines);
  EXPECT_GT(s.share(), 0.9);
  EXPECT_LT(s.rms, 0.01);
  EXPECT_LT(s.worst, 0.05);
}

TEST(LidarDepth, OfAPillarNotOfTheWallBehindIt) {
  const Box wall{{8, -20, -20}, {9, 20, 20}}, pillar{{4, -0.3, -20}, {4.4, 0.3, 20}};
  LidarDepth depth({}, kRig);
  // First from the side, past the pillar, from many heights: the wall behind it is densely covered.
  for (int k = 0; k < 20; ++k) {
    SE3 aside = at(2.5, 3.0 - 0.02 * k, -0.4);
    aside.translation.z() += 0.03 * k;
    add_scan(depth, {wall}, aside, {k * int64_t{100'000'000}});
  }
  const Scene scene{wall, pillar};
  add_scan(depth, scene, at(0, 0), {2'100'000'000});
  VisualFrame frame = grid({2'100'000'000});
  const SE3 T_odom_camera = camera_at(at(0, 0));
  depth.fill(frame, T_odom_camera);
  const auto on_pillar = [&](const VisualFeature& f) {
    return within_the_scan_lines(f) && true_depth_m(scene, T_odom_camera, f.ray_camera) < 5;
  };
  const Score near = score(frame, scene, T_odom_camera, on_pillar);
  EXPECT_GT(near.features, 20);
  EXPECT_GT(near.share(), 0.4);  // at its edges the depth is open
  EXPECT_LT(near.worst, 0.05);
  const Score s = score(frame, scene, T_odom_camera, within_the_scan_lines);
  EXPECT_GT(s.share(), 0.8);
  EXPECT_LT(s.rms, 0.02);
}

TEST(LidarDepth, OfACorridorOnTheWay) {
  const Scene scene = jambed_corridor(40, 4, 0.15);
  LidarDepth depth({}, kRig);
  for (int k = 0; k < 30; ++k) add_scan(depth, scene, at(0.1 * k, 0.1, 0.02), {k * int64_t{100'000'000}});
  VisualFrame frame = grid({2'950'000'000});
  const SE3 T_odom_camera = camera_at(at(2.95, 0.1, 0.02));
  depth.fill(frame, T_odom_camera);
  const Score s = score(frame, scene, T_odom_camera, any);
  EXPECT_GT(s.share(), 0.4);
  EXPECT_LT(s.rms, 0.03);
}

TEST(LidarDepth, RefusesWhatIsGrazed) {
  // The floor, 0.6 m below: seen at less than 5 deg beyond 6.9 m.
  const Scene scene{{{-50, -50, -1}, {50, 50, 0}}};
  LidarDepth depth({}, kRig);
  for (int k = 0; k < 40; ++k) {
    SE3 pose = at(0.25 * k, 0);
    add_scan(depth, scene, pose, {k * int64_t{100'000'000}});
  }
  VisualFrame frame = grid({3'900'000'000});
  const SE3 T_odom_camera = camera_at(at(5, 0));
  depth.fill(frame, T_odom_camera);
  int near = 0;
  for (const VisualFeature& f : frame.features) {
    EXPECT_TRUE(f.ray_camera.y() > std::tan(4.0 * std::numbers::pi / 180) || f.depth_m == 0);
    near += f.depth_m > 0 ? 1 : 0;
  }
  EXPECT_GT(near, 200);
}

TEST(LidarDepth, IsUnknownWithoutPointsAhead) {
  LidarDepth depth({}, kRig);
  VisualFrame frame = grid({});
  frame.features[7].depth_m = 3;
  depth.fill(frame, SE3());
  EXPECT_EQ(score(frame, {}, SE3(), any).with_depth, 0);

  const Scene scene{{{5, -20, -20}, {6, 20, 20}}};
  add_scan(depth, scene, at(0, 0), {});
  depth.fill(frame, camera_at(at(0, 0, std::numbers::pi)));  // the wall is behind
  EXPECT_EQ(score(frame, scene, SE3(), any).with_depth, 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  depth.add({1}, {{nan, nan, nan}, {nan, 0, 0}}, at(0, 0));
  depth.add({2}, {}, at(0, 0));
  frame.features[0].ray_camera = {std::nan(""), 0};
  frame.features[1].ray_camera = {1e9, -1e9};
  depth.fill(frame, camera_at(at(0, 0)));
  EXPECT_EQ(frame.features[0].depth_m, 0);
  EXPECT_EQ(frame.features[1].depth_m, 0);
}

TEST(LidarDepth, ForgetsOldScans) {
  const Scene scene{{{5, -20, -20}, {6, 20, 20}}};
  LidarDepth depth({.max_age_s = 1, .view = {}}, kRig);
  add_scan(depth, scene, at(0, 0), {});
  VisualFrame frame = grid({2'000'000'000});
  depth.fill(frame, camera_at(at(0, 0)));
  EXPECT_EQ(score(frame, scene, camera_at(at(0, 0)), any).with_depth, 0);
  const size_t one = depth.points();
  add_scan(depth, scene, at(1, 0), {2'000'000'000});
  EXPECT_LT(depth.points(), 2 * one);
}

TEST(LidarDepth, HoldsNoMoreThanItMay) {
  const Scene scene = corridor(60);
  LidarDepth still({}, kRig), moving({.max_points = 20000, .view = {}}, kRig);
  std::vector<size_t> held;
  for (int k = 0; k < 12; ++k) {
    const Time stamp{k * int64_t{100'000'000}};
    add_scan(still, scene, at(0, 0), stamp);
    add_scan(moving, scene, at(0.5 * k, 0), stamp);
    held.push_back(still.points());
    EXPECT_LE(moving.points(), 20000u);
  }
  EXPECT_LT(held.back(), 2.1 * static_cast<double>(held.front()));  // the first and the newest
  EXPECT_GT(moving.points(), 5000u);
}

}  // namespace
}  // namespace vsslam

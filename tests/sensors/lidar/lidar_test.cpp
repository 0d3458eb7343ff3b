#include "sensors/lidar/lidar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/ordered_parallel.h"
#include "sensors/lidar/lidar_errors.h"
#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

LidarMeasurement scan_of(const World& world, const LidarConfig& config, const Trajectory& trajectory,
                         const SE3& T_base_lidar = SE3(), uint64_t seed = 1, int revolution_index = 0) {
  const Raycaster raycaster(world);
  Lidar lidar(config, {}, seed, raycaster);
  Revolution revolution = lidar.power_on(Time{0});
  for (int i = 0; i < revolution_index; ++i) revolution = lidar.after(revolution);
  return lidar.scan(revolution, trajectory, T_base_lidar);
}

World wall_world(const Vec3& point, const Vec3& normal, double size_m, float albedo = 0.5f) {
  World world;
  world.materials = {shapes::paint(albedo)};
  shapes::add(world, shapes::wall(point, normal, size_m), "wall", 0);
  return world;
}

bool same_points(const LidarMeasurement& a, const LidarMeasurement& b) {
  if (a.scan.points.size() != b.scan.points.size()) return false;
  for (size_t i = 0; i < a.scan.points.size(); ++i) {
    const LidarPoint &p = a.scan.points[i], &q = b.scan.points[i];
    if (p.x != q.x || p.y != q.y || p.z != q.z || p.intensity != q.intensity || p.ring != q.ring ||
        p.time_s != q.time_s)
      return false;
    if (a.truth[i].position_lidar != b.truth[i].position_lidar ||
        a.truth[i].triangle != b.truth[i].triangle || a.truth[i].range_m != b.truth[i].range_m)
      return false;
  }
  return true;
}

/// What the device reported as range: the distance from where the beam crosses the axis.
double reported_range(const LidarPoint& p, LidarModel model = LidarModel::vlp16) {
  for (const Laser& laser : laser_table(model).lasers)
    if (laser.ring == p.ring) return std::hypot(p.x, p.y, p.z - laser.dz_m);
  return 0;
}

TEST(Lidar, WallAtFiveMetres) {
  // 50 m from the origin, so that the rounding of coordinates shows.
  const Vec3 origin(50, -30, 2);
  const World world = wall_world(origin + Vec3(5, 0, 0), {-1, 0, 0}, 60);
  const LidarMeasurement m =
      scan_of(world, LidarConfig::ideal(), shapes::at_rest(SE3(Quat::Identity(), origin), 1));
  ASSERT_GT(m.scan.points.size(), 10000u);
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    EXPECT_NEAR(m.scan.points[i].x, 5, 1e-5 * (1 + m.truth[i].range_m / 10));
    EXPECT_NEAR(m.truth[i].position_lidar.x(), 5, 1e-5 * (1 + m.truth[i].range_m / 10));
    EXPECT_NEAR((m.truth[i].normal_lidar - Vec3f(-1, 0, 0)).norm(), 0, 1e-6);
    EXPECT_NEAR(m.truth[i].cos_incidence, 5 / (m.truth[i].range_m - 0.0), 0.01);
  }
}

// The plane n.p = d seen in motion: each point lies on it from the pose of its own firing, and each
// undistorted twin from the pose at the scan's stamp.
TEST(Lidar, TiltedPlaneFromAMovingRobot) {
  const Vec3 normal = Vec3(-1, 0.4, 0.3).normalized(), point(6, 0, 0);
  const World world = wall_world(point, normal, 80);
  const Trajectory trajectory = shapes::along(shapes::lively, 1);
  const SE3 T_base_lidar = SE3::from_rpy({0.02, -0.05, 0.3}, {0.1, 0.05, 0.45});
  for (int revolution : {0, 3}) {
    const LidarMeasurement m = scan_of(world, LidarConfig::ideal(), trajectory, T_base_lidar, 1, revolution);
    ASSERT_GT(m.scan.points.size(), 8000u);
    double worst_firing = 0, worst_twin = 0, worst_still = 0;
    for (size_t i = 0; i < m.scan.points.size(); ++i) {
      const LidarPoint& p = m.scan.points[i];
      const Time fired = m.scan.stamp + Duration::from_seconds(static_cast<double>(p.time_s));
      const Vec3 p_world = trajectory.pose(fired) * T_base_lidar * Vec3(p.x, p.y, p.z);
      const Vec3 still_world = m.T_world_lidar * Vec3(p.x, p.y, p.z);
      const Vec3 twin_world = m.T_world_lidar * m.truth[i].position_lidar.cast<double>();
      const double scale = 1 + m.truth[i].range_m / 10;
      worst_firing = std::max(worst_firing, std::abs(normal.dot(p_world - point)) / scale);
      worst_twin = std::max(worst_twin, std::abs(normal.dot(twin_world - point)) / scale);
      worst_still = std::max(worst_still, std::abs(normal.dot(still_world - point)) / scale);
    }
    EXPECT_LT(worst_firing, 2e-5);
    EXPECT_LT(worst_twin, 2e-5);
    EXPECT_GT(worst_still, 0.01);  // the motion matters
  }
}

TEST(Lidar, OnePoseForTheScanWhenAskedFor) {
  const World world = wall_world({6, 0, 0}, {-1, 0, 0}, 80);
  const Trajectory trajectory = shapes::along(shapes::lively, 1);
  LidarConfig config = LidarConfig::ideal();
  config.pose_per_firing = false;
  const LidarMeasurement m = scan_of(world, config, trajectory);
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    const LidarPoint& p = m.scan.points[i];
    EXPECT_NEAR((m.truth[i].position_lidar - Vec3f(p.x, p.y, p.z)).norm(), 0,
                1e-5 * (1 + m.truth[i].range_m));
  }
}

TEST(Lidar, SphereFromOffCentre) {
  const double radius = 4;
  Primitive sphere;
  const int rows = 200, columns = 400;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double polar = std::numbers::pi * r / rows, around = 2 * std::numbers::pi * c / columns;
      const Vec3 n(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
      sphere.positions.push_back((radius * n).cast<float>());
      sphere.normals.push_back((-n).cast<float>());
    }
  }
  const auto at = [&](int r, int c) { return static_cast<uint32_t>(r * columns + c % columns); };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      sphere.triangles.push_back({at(r, c), at(r, c + 1), at(r + 1, c)});
      sphere.triangles.push_back({at(r + 1, c), at(r, c + 1), at(r + 1, c + 1)});
    }
  World world;
  world.materials = {shapes::paint(0.5f)};
  shapes::add(world, std::move(sphere), "sphere", 0);
  const Vec3 origin(1, -0.5, 0.3);
  const LidarMeasurement m =
      scan_of(world, LidarConfig::ideal(), shapes::at_rest(SE3(Quat::Identity(), origin), 1));
  EXPECT_GE(m.scan.points.size(), 1808u * 16);
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    const Vec3 p = origin + Vec3(m.scan.points[i].x, m.scan.points[i].y, m.scan.points[i].z);
    EXPECT_NEAR(p.norm(), radius, 4e-4);  // the chord of a facet
    const Vec3 to_centre = -p.normalized();
    EXPECT_NEAR(to_centre.dot(m.truth[i].normal_lidar.cast<double>()), 1, 5e-4);
  }
}

// Two walls, one behind the other, split at y = 0.
World edge_world(double gap_m) {
  World world;
  world.materials = {shapes::paint(0.5f)};
  shapes::add(world, shapes::quad({5, 0, -3}, {0, 3, 0}, {0, 0, 6}), "near", 0);
  shapes::add(world, shapes::quad({5 + gap_m, -4, -4}, {0, 8, 0}, {0, 0, 8}), "far", 0);
  return world;
}

size_t between(const LidarMeasurement& m, double low_x, double high_x) {
  return static_cast<size_t>(
      std::count_if(m.scan.points.begin(), m.scan.points.end(),
                    [&](const LidarPoint& p) { return p.x > low_x + 0.02 && p.x < high_x - 0.02; }));
}

TEST(Lidar, EdgesMixOnlyWithinAPulse) {
  LidarConfig config = LidarConfig::ideal();
  const Trajectory rest = shapes::at_rest(SE3(), 1);
  EXPECT_EQ(between(scan_of(edge_world(0.5), config, rest), 5, 5.5), 0u);
  config.sub_rays = 19;
  const LidarMeasurement mixed = scan_of(edge_world(0.5), config, rest);
  EXPECT_GE(between(mixed, 5, 5.5), 8u);
  EXPECT_EQ(between(scan_of(edge_world(1.5), config, rest), 5, 6.5), 0u);
  // A footprint on a plane does not move the point.
  for (const LidarPoint& p : mixed.scan.points) {
    if (p.y < 0.2 || p.y > 2.8) continue;
    EXPECT_NEAR(p.x, 5, 1e-3);
  }
}

TEST(Lidar, LastReturnIsTheFarOne) {
  LidarConfig config = LidarConfig::ideal();
  config.sub_rays = 19;
  const Trajectory rest = shapes::at_rest(SE3(), 1);
  const auto far_points = [&] {
    const LidarMeasurement m = scan_of(edge_world(1.5), config, rest);
    return between(m, 6, 7);
  };
  const size_t strongest = far_points();
  config.return_mode = LidarConfig::ReturnMode::last;
  EXPECT_GT(far_points(), strongest + 10);
}

TEST(Lidar, AzimuthPhaseMovesFromScanToScan) {
  const World world = shapes::room_world({-5, -5, -5}, {5, 5, 5});
  const Raycaster raycaster(world);
  Lidar lidar(LidarConfig::ideal(), {}, 1, raycaster);
  Revolution revolution = lidar.power_on(Time{0});
  const Trajectory rest = shapes::at_rest(SE3(), 0.5);
  const double step_deg = 360 * 10 * 55.296e-6;
  EXPECT_NEAR(step_deg, 0.199066, 1e-6);
  for (int k = 0; k < 3; ++k) {
    const LidarMeasurement m = lidar.scan(revolution, rest, SE3());
    EXPECT_EQ(m.scan.stamp.ns, revolution.first_cycle * 55296);
    EXPECT_EQ(m.scan.end.ns, (revolution.first_cycle + revolution.cycles - 1) * 55296 + 34560);
    ASSERT_EQ(m.scan.points.size(), static_cast<size_t>(16 * revolution.cycles));
    for (size_t i = 0; i < m.scan.points.size(); ++i) {
      const LidarPoint& p = m.scan.points[i];
      const size_t cycle = i / 16, id = i % 16;
      EXPECT_EQ(p.ring, id % 2 == 0 ? id / 2 : 8 + id / 2);
      EXPECT_NEAR(p.time_s, 55.296e-6 * static_cast<double>(cycle) + 2.304e-6 * static_cast<double>(id),
                  1e-8);
      // Clockwise, advancing within the cycle too.
      const double turned = step_deg * (static_cast<double>(revolution.first_cycle) +
                                        static_cast<double>(i / 16) + static_cast<double>(id) / 24);
      const double azimuth_deg = -std::atan2(p.y, p.x) / kDeg;
      EXPECT_NEAR(std::remainder(turned - azimuth_deg, 360), 0, 1e-4);
      const double elevation_deg =
          std::atan2(p.z - laser_table(LidarModel::vlp16).lasers[id].dz_m, std::hypot(p.x, p.y)) / kDeg;
      EXPECT_NEAR(elevation_deg, id % 2 == 0 ? static_cast<double>(id) - 15 : static_cast<double>(id), 1e-4);
    }
    revolution = lidar.after(revolution);
  }
  // 1808.449 cycles a revolution: whole numbers that average to it.
  revolution = lidar.power_on(Time{0});
  for (int k = 0; k < 2000; ++k) {
    EXPECT_TRUE(revolution.cycles == 1808 || revolution.cycles == 1809);
    revolution = lidar.after(revolution);
  }
  EXPECT_EQ(revolution.first_cycle, static_cast<int64_t>(std::ceil(2000 / (10 * 55.296e-6))));
}

TEST(Lidar, Vlp32cFollowsItsTable) {
  const LaserTable& table = laser_table(LidarModel::vlp32c);
  ASSERT_EQ(table.lasers.size(), 32u);
  EXPECT_EQ(table.lasers[0].ring, 0);
  EXPECT_EQ(table.lasers[29].ring, 31);
  EXPECT_EQ(table.lasers[31].fire_offset_ns, 15 * 2304);
  LidarConfig config = LidarConfig::ideal(LidarModel::vlp32c);
  config.max_range_m = 200;
  const LidarMeasurement m =
      scan_of(shapes::room_world({-5, -5, -5}, {5, 5, 5}), config, shapes::at_rest(SE3(), 1));
  ASSERT_EQ(m.scan.points.size() % 32, 0u);
  for (size_t i = 0; i < 32 * 100; ++i) {
    const LidarPoint& p = m.scan.points[i];
    const Laser& laser = table.lasers[i % 32];
    EXPECT_EQ(p.ring, laser.ring);
    const double turned =
        360 * 10 *
        (55.296e-6 * static_cast<double>(i / 32) + 1e-9 * static_cast<double>(laser.fire_offset_ns));
    EXPECT_NEAR(std::remainder(std::atan2(p.y, p.x) / kDeg + turned - laser.azimuth_offset_rad / kDeg, 360),
                0, 1e-4);
    EXPECT_NEAR(std::atan2(p.z - laser.dz_m, std::hypot(p.x, p.y)), laser.elevation_rad, 1e-6);
  }
}

TEST(Lidar, NoiseHasItsSigmaAndLasersTheirBias) {
  const World world = shapes::room_world({-5, -5, -5}, {5, 5, 5});
  LidarConfig config = LidarConfig::ideal();
  config.range_sigma_m = 0.02;
  config.laser_bias_sigma_m = 0.01;
  const LidarMeasurement m = scan_of(world, config, shapes::at_rest(SE3(), 1));
  const LidarErrors errors(config, 16, 1);
  std::vector<double> sum(16), sum2(16), count(16);
  double sum4 = 0;
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    const size_t id = i % 16;
    const double residual = reported_range(m.scan.points[i]) - m.truth[i].range_m - errors.laser_bias_m(id);
    sum[id] += residual, sum2[id] += residual * residual, ++count[id];
    sum4 += std::pow(residual / config.range_sigma_m, 4);
  }
  double all = 0, n = 0, biases = 0;
  for (size_t id = 0; id < 16; ++id) {
    EXPECT_NEAR(sum[id] / count[id], 0, 5 * 0.02 / std::sqrt(count[id])) << id;
    all += sum2[id], n += count[id];
    biases += std::pow(errors.laser_bias_m(id) / config.laser_bias_sigma_m, 2);
  }
  EXPECT_NEAR(std::sqrt(all / n), 0.02, 5 * 0.02 / std::sqrt(2 * n));
  EXPECT_NEAR(sum4 / n, 3, 5 * std::sqrt(96 / n));
  EXPECT_GT(biases, 4);
  EXPECT_LT(biases, 40);
}

// Each error on its own against all errors: what the others do is the same to the bit.
TEST(Lidar, SwitchingOneErrorOffLeavesTheOthers) {
  const World world = shapes::room_world({-7, -6, -2}, {5, 8, 3});
  const Trajectory trajectory = shapes::along(shapes::lively, 0.5);
  const LidarMeasurement all = scan_of(world, {}, trajectory);
  LidarConfig quiet;
  quiet.intensity_sigma = 0;
  const LidarMeasurement no_intensity = scan_of(world, quiet, trajectory);
  ASSERT_EQ(all.scan.points.size(), no_intensity.scan.points.size());
  size_t differing = 0;
  for (size_t i = 0; i < all.scan.points.size(); ++i) {
    EXPECT_EQ(all.scan.points[i].x, no_intensity.scan.points[i].x);
    EXPECT_EQ(all.scan.points[i].z, no_intensity.scan.points[i].z);
    differing += all.scan.points[i].intensity != no_intensity.scan.points[i].intensity;
  }
  EXPECT_GT(differing, all.scan.points.size() / 4);

  LidarConfig exact_range;
  exact_range.range_sigma_m = exact_range.laser_bias_sigma_m = exact_range.incidence_bias_scale = 0;
  const LidarMeasurement no_range = scan_of(world, exact_range, trajectory);
  ASSERT_EQ(all.scan.points.size(), no_range.scan.points.size());
  differing = 0;
  for (size_t i = 0; i < all.scan.points.size(); ++i) {
    const LidarPoint &p = all.scan.points[i], &q = no_range.scan.points[i];
    EXPECT_EQ(p.intensity, q.intensity);
    EXPECT_NEAR(std::atan2(p.y, p.x), std::atan2(q.y, q.x), 1e-6);  // the same azimuth errors
    differing += p.x != q.x;
  }
  EXPECT_GT(differing, all.scan.points.size() / 2);
}

TEST(Lidar, RangesAreWholeSteps) {
  LidarConfig config = LidarConfig::ideal();
  config.range_step_m = 0.002;
  config.range_sigma_m = 0.007;
  const LidarMeasurement m =
      scan_of(shapes::room_world({-5, -5, -5}, {5, 5, 5}), config, shapes::at_rest(SE3(), 1));
  for (const LidarPoint& p : m.scan.points) {
    const double steps = reported_range(p) / 0.002;
    EXPECT_NEAR(steps, std::round(steps), 2e-3);
  }
}

TEST(Lidar, IncidenceBiasAsPublished) {
  EXPECT_EQ(incidence_bias_m(1, 10), 0);
  // The published model with its constants for an HDL-32E, evaluated apart; mm at 1.2, 10 and 40 m.
  const double published[][4] = {{10, 0.11, 0.11, 0.13},    {30, 1.10, 1.14, 1.27},    {45, 2.95, 3.06, 3.46},
                                 {60, 7.13, 7.47, 8.67},    {70, 13.74, 14.61, 17.62}, {75, 20.49, 22.11, 27.67},
                                 {80, 34.20, 37.94, 50.85}, {83, 52.06, 59.79, 86.61}, {85, 76.21, 91.46, 144.89}};
  for (const auto& [deg, at_1_2_m, at_10_m, at_40_m] : published) {
    const double c = std::cos(deg * kDeg);
    EXPECT_NEAR(incidence_bias_m(c, 1.2), 1e-3 * at_1_2_m, 2e-5 * at_1_2_m + 1e-5);
    EXPECT_NEAR(incidence_bias_m(c, 10), 1e-3 * at_10_m, 2e-5 * at_10_m + 1e-5);
    EXPECT_NEAR(incidence_bias_m(c, 40), 1e-3 * at_40_m, 2e-5 * at_40_m + 1e-5);
  }
  LidarConfig config = LidarConfig::ideal();
  config.incidence_bias_scale = 1;
  const LidarMeasurement m =
      scan_of(wall_world({0, 1.2, 0}, {0, -1, 0}, 60), config, shapes::at_rest(SE3(), 1));
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    const double expected = incidence_bias_m(m.truth[i].cos_incidence, m.truth[i].range_m);
    EXPECT_NEAR(reported_range(m.scan.points[i]) - m.truth[i].range_m, expected, 2e-4 + 0.01 * expected);
  }
}

TEST(Lidar, WeakEchoesAreLost) {
  const Trajectory rest = shapes::at_rest(SE3(), 1);
  LidarConfig config = LidarConfig::ideal();
  config.dropout = true;
  config.detection_range_m = 20;
  // A ball-like room would be head-on everywhere; here a small wall is, nearly.
  const auto share = [&](double distance_m, float albedo) {
    const World world = wall_world({distance_m, 0, 0}, {-1, 0, 0}, 3, albedo);
    config.dropout = true;
    const auto seen = static_cast<double>(scan_of(world, config, rest).scan.points.size());
    config.dropout = false;
    return seen / static_cast<double>(scan_of(world, config, rest).scan.points.size());
  };
  EXPECT_EQ(share(8, 0.1f), 1);
  EXPECT_NEAR(share(20, 0.1f), 0.5, 0.2);
  EXPECT_LT(share(25, 0.1f), 0.05);
  EXPECT_EQ(share(20, 0.8f), 1);  // eight times the albedo, 2.8 times the range
  EXPECT_EQ(share(70, 0.1f), 0);
}

TEST(Lidar, IntensityIsAlbedoTimesCosine) {
  World world = wall_world({5, 0, 0}, {-1, 0, 0}, 30, 0.6f);
  const Trajectory rest = shapes::at_rest(SE3(), 1);
  for (const LidarMeasurement& m : {scan_of(world, LidarConfig::ideal(), rest)})
    for (size_t i = 0; i < m.scan.points.size(); ++i)
      EXPECT_NEAR(m.scan.points[i].intensity, 60 * m.truth[i].cos_incidence, 0.51);
  world.materials[0].retro_reflective = true;
  const LidarMeasurement retro = scan_of(world, LidarConfig{}, rest);
  EXPECT_GT(retro.scan.points.size(), 1000u);
  for (const LidarPoint& p : retro.scan.points) EXPECT_GE(p.intensity, 101);
}

TEST(Lidar, GlassLetsTheWallBehindReturn) {
  World world;
  world.materials = {shapes::paint(0.5f), shapes::paint(0.5f)};
  world.materials[1].glass = true;
  shapes::add(world, shapes::wall({5, 0, 0}, {-1, 0, 0}, 20), "wall", 0);
  shapes::add(world, shapes::wall({3, 0, 0}, {-1, 0.5, 0}, 20), "pane", 1);
  const LidarMeasurement m = scan_of(world, LidarConfig{}, shapes::at_rest(SE3(), 1));
  size_t on_wall = 0, on_pane = 0;
  for (const PointTruth& truth : m.truth) ++(truth.object == 0 ? on_wall : on_pane);
  EXPECT_GT(on_wall, 3000u);
  EXPECT_LT(on_pane, on_wall / 10);
  // Alone in the world, a slanted pane returns next to nothing.
  world.objects.erase(world.objects.begin());
  EXPECT_LT(scan_of(world, LidarConfig{}, shapes::at_rest(SE3(), 1)).scan.points.size(), 200u);
}

TEST(Lidar, EmptyWorldGivesAnEmptyScanWithStamps) {
  const World nothing;
  const LidarMeasurement m = scan_of(nothing, LidarConfig{}, shapes::at_rest(SE3(), 1), SE3(), 1, 1);
  EXPECT_TRUE(m.scan.points.empty());
  EXPECT_GT(m.scan.stamp.ns, 99'000'000);
  EXPECT_LT(m.scan.end.ns, 201'000'000);
}

TEST(Lidar, NothingBelowTheMinimumRange) {
  LidarConfig config;
  const LidarMeasurement m =
      scan_of(shapes::room_world({-0.8, -3, -2}, {3, 3, 2}), config, shapes::at_rest(SE3(), 1));
  EXPECT_GT(m.scan.points.size(), 1000u);
  for (const LidarPoint& p : m.scan.points) EXPECT_GE(reported_range(p), 0.9 - 1e-6);
}

TEST(Lidar, ThreadsDoNotShow) {
  World world = shapes::room_world({-7, -6, -2}, {5, 8, 3});
  world.materials.push_back(shapes::paint(0.1f));
  world.materials.back().glass = true;
  shapes::add(world, shapes::wall({3, 1, 0}, {-1, 0.2, 0}, 3), "pane", 1);
  const Trajectory trajectory = shapes::along(shapes::lively, 0.5);
  LidarConfig config;
  config.sub_rays = 3;
  set_thread_count(1);
  const LidarMeasurement one = scan_of(world, config, trajectory);
  set_thread_count(4);
  const LidarMeasurement four = scan_of(world, config, trajectory);
  set_thread_count(2);
  const LidarMeasurement other_seed = scan_of(world, config, trajectory, SE3(), 2);
  EXPECT_TRUE(same_points(one, four));
  EXPECT_FALSE(same_points(one, other_seed));
  for (size_t i = 1; i < one.scan.points.size(); ++i)
    EXPECT_LE(one.scan.points[i - 1].time_s, one.scan.points[i].time_s);
}

}  // namespace
}  // namespace vsslam

#include "slam/lidar/features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "slam/lidar/surface_features.h"
#include "slam/lidar/voxel_hash.h"
#include "slam/undistort.h"
#include "tests/slam/analytic_scene.h"

namespace vsslam {
namespace {

using namespace testing_scene;

const Noise kQuiet{.range_sigma_m = 0, .gyro_bias_radps = 0, .imu = false, .seed = 1};

constexpr double kSigma_m = 0.007;

std::vector<Feature> features_of(const LidarScan& s, const FeatureConfig& config = {}) {
  return select_planar_features(s, undistort(s, MotionPath(s.stamp), rig().lidar.T_base_lidar), kSigma_m, config);
}
LidarScan scan_at_origin(const Scene& scene, const Noise& noise = kQuiet) {
  return scan(
      scene,
      [](double) {
        return SE3(Quat::Identity(), {0, 0, 0.2});
      },
      rig(), Time{}, noise);
}

TEST(Undistort, PutsAMovingScanWhereAStillOneWouldBe) {
  const Motion fast = [](double t) {
    return SE3::from_rpy({0.05 * std::sin(9 * t), 0.1 * t, 2.0 * t}, {1.5 * t, -0.4 * t, 0.3});
  };
  const RigCalibration calibration = rig();
  const Time stamp = Time::from_seconds(0.3);
  const LidarScan s = scan(room(), fast, calibration, stamp, kQuiet, 8);
  MotionPath path(stamp);
  for (int i = 1; i <= 20; ++i)
    path.append(stamp + Duration{i * 5'000'000}, fast(0.3).inverse() * fast(0.3 + 0.005 * i));
  const Cloud points_lidar = undistort(s, path, calibration.lidar.T_base_lidar);
  ASSERT_EQ(points_lidar.size(), s.points.size());
  // On a still sensor each point lies on the scene's surface in its direction.
  const SE3 T_scene_lidar = fast(0.3) * calibration.lidar.T_base_lidar;
  double worst_m = 0;
  size_t hidden = 0;
  for (const Eigen::Vector3f& point : points_lidar) {
    const Vec3 p = point.cast<double>();
    const double range_m =
        cast_ray(room(), T_scene_lidar.translation, T_scene_lidar.rotation * p.normalized());
    const double error_m = std::abs(range_m - p.norm());
    if (error_m > 0.05)
      ++hidden;  // seen past an edge while moving
    else
      worst_m = std::max(worst_m, error_m);
  }
  EXPECT_LT(worst_m, 0.002);
  EXPECT_LT(hidden, points_lidar.size() / 50);
}

TEST(Undistort, RotationAloneIsNotEnough) {
  const Motion forward = [](double t) { return SE3(Quat::Identity(), {1.5 * t, 0, 0.2}); };
  const LidarScan s = scan(room(), forward, rig(), Time{}, kQuiet, 8);
  MotionPath path(Time{});
  path.append(s.end, forward(s.end.seconds()));
  const Cloud moved = undistort(s, path, rig().lidar.T_base_lidar),
              still = undistort(s, MotionPath(Time{}), rig().lidar.T_base_lidar);
  EXPECT_NEAR((moved.back() - still.back()).x(), 1.5 * s.end.seconds(), 0.002);
  EXPECT_LT((moved.front() - still.front()).norm(), 1e-4);
}

TEST(Features, AreOnSurfacesAndAwayFromShadows) {
  // A pillar before a wall: the wall is dropped beside the pillar's shadow.
  Scene scene = hollow({-8, -8, 0}, {8, 8, 3});
  scene.push_back({{2.0, -0.2, 0}, {2.4, 0.2, 3}});
  const auto features = features_of(scan_at_origin(scene));
  EXPECT_GT(features.size(), 15000u);
  const double shadow = std::atan2(0.2, 1.9);  // edge of the shadow seen from the LiDAR at x = 0.1
  for (const Feature& f : features) {
    const double azimuth = std::abs(std::atan2(f.point_lidar.y(), f.point_lidar.x()));
    if (f.point_lidar.x() > 7) {
      EXPECT_GT(azimuth, shadow + 5 * 0.00347) << f.point_lidar.transpose();
    }
  }
}

TEST(Features, RejectParallelBeamsAndNearPoints) {
  const auto features = features_of(scan_at_origin(corridor(400)));
  for (const Feature& f : features) {
    EXPECT_GE(f.point_lidar.norm(), 1.0);
    const bool wall = std::abs(std::abs(f.point_lidar.y()) - 1.2) < 1e-3;
    // 80 deg from the normal at 1.2 m is 6.8 m along the wall for a level ring, more for a steep one.
    if (wall) {
      EXPECT_LT(std::abs(f.point_lidar.x()), 9.0);
    }
  }
  FeatureConfig generous;
  generous.parallel_beam_deg = 89;
  EXPECT_GT(features_of(scan_at_origin(corridor(400)), generous).size(), features.size() + 500);
}

TEST(Features, KeepNarrowFaces) {
  const auto features = features_of(scan_at_origin(jambed_corridor(50, 4, 0.15), {}));
  size_t on_jamb = 0;
  for (const Feature& f : features) {
    const float x = f.point_lidar.x() + 0.1f;  // jambs start at x = -49 + 4 i
    const float to_face = std::abs(std::remainder(x + 49.0f, 4.0f));
    if (to_face < 0.02f && std::abs(f.chord_lidar.y()) > 0.8f * f.chord_lidar.norm() &&
        std::abs(f.point_lidar.y()) > 1.03f)
      ++on_jamb;
  }
  EXPECT_GT(on_jamb, 150u);
}

TEST(Features, ToleratesEmptyAndTinyScans) {
  EXPECT_TRUE(features_of(LidarScan{}).empty());
  LidarScan tiny;
  tiny.end = Time{1000};
  tiny.points.resize(3, {2, 0, 0, 1, 3, 0});
  tiny.points.push_back({2, 0, 0, 1, 200, 0});  // a ring far from the others
  EXPECT_TRUE(features_of(tiny).empty());
}

double measured_sigma_m(const LidarScan& s) {
  const Cloud points_lidar = undistort(s, MotionPath(s.stamp), rig().lidar.T_base_lidar);
  return measured_range_sigma_m(RingOrder(s, points_lidar, 0.3));
}

TEST(RangeNoise, IsMeasuredFromNeighboursInARing) {
  for (const double sigma_m : {0.003, 0.007, 0.015, 0.03, 0.05}) {
    const Noise noise{.range_sigma_m = sigma_m};
    EXPECT_NEAR(measured_sigma_m(scan_at_origin(room(), noise)), sigma_m, 0.1 * sigma_m);
    EXPECT_NEAR(measured_sigma_m(scan_at_origin(jambed_corridor(50, 4, 0.15), noise)), sigma_m, 0.2 * sigma_m);
  }
}

TEST(RangeNoise, IsZeroWhereThereIsTooLittleToTell) {
  EXPECT_EQ(measured_sigma_m(LidarScan{}), 0);
}

// The same places are features, whatever a driver does to the order and the times of the points.
TEST(RingOrder, StandsSecondReturnsAndJitter) {
  const LidarScan clean = scan_at_origin(room(), {});
  const size_t usual = features_of(clean).size();
  LidarScan doubled = clean, jittered = clean, timeless = clean;
  for (size_t i = 0; i < clean.points.size(); i += 50) {
    LidarPoint second = clean.points[i];
    second.x *= 1.3f, second.y *= 1.3f, second.z *= 1.3f;
    second.time_s += 3e-6f;
    doubled.points.insert(doubled.points.begin() + static_cast<std::ptrdiff_t>(i + i / 50 + 1), second);
  }
  const RandomStream jitter(1, "jitter");
  for (size_t i = 0; i < clean.points.size(); ++i) {
    jittered.points[i].time_s += static_cast<float>(60e-6 * (2 * jitter.uniform(Time{}, i) - 1));
    timeless.points[i].time_s = 0;
  }
  const auto count = [](const LidarScan& s) { return static_cast<double>(features_of(s).size()); };
  EXPECT_GT(count(doubled), 0.97 * static_cast<double>(usual));
  EXPECT_GT(count(jittered), 0.9 * static_cast<double>(usual));
  EXPECT_GT(count(timeless), 0.9 * static_cast<double>(usual));
}

TEST(RingOrder, OnePairOfReturnsIsNotTheFiringPeriod) {
  LidarScan pair = scan_at_origin(room(), {});
  const size_t usual = features_of(pair).size();
  LidarPoint second = pair.points[1000];
  second.time_s += 3e-6f;
  pair.points.insert(pair.points.begin() + 1001, second);
  EXPECT_NEAR(static_cast<double>(features_of(pair).size()), static_cast<double>(usual), 12);
}

TEST(SurfaceFeatures, LieOnTheSurfacesOfAScanWithoutRings) {
  const LidarScan s = scan_at_origin(room(), {});
  const Cloud points_lidar = undistort(s, MotionPath(s.stamp), rig().lidar.T_base_lidar);
  const double sigma_m = measured_surface_sigma_m(points_lidar, 0.2, {});
  EXPECT_NEAR(sigma_m, 0.007, 0.003);
  const auto features = select_surface_features(points_lidar, 0.007, 0.2, {});
  ASSERT_GT(features.size(), 500u);
  size_t along = 0;
  for (const Feature& f : features) {
    const bool east_or_west = std::abs(std::abs(f.point_lidar.x() + 0.1f) - 6) < 0.03f;
    const bool inside = std::abs(f.point_lidar.y()) < 4.5f && std::abs(f.point_lidar.z() + 0.6f - 1.5f) < 1.2f;
    if (!east_or_west || !inside) continue;
    ++along;
    EXPECT_LT(std::abs(f.chord_lidar.x()), 0.3f * f.chord_lidar.norm());
  }
  EXPECT_GT(along, 50u);
}

TEST(Thinning, KeepsOnePerCellAndDirection) {
  std::vector<Feature> features;
  for (int i = 0; i < 100; ++i)
    features.push_back({{5, 0.01f + 0.001f * static_cast<float>(i), 0.05f},
                        {i % 2 ? 1.0f : 0.0f, i % 2 ? 0.0f : 1.0f, 0.0f},
                        0});
  const auto kept = thin_features(features, 0.2);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].point_lidar, features[0].point_lidar);
  EXPECT_EQ(kept[1].point_lidar, features[1].point_lidar);
}

// At all ranges and in all directions: neighbours on a sphere are about as far apart as asked for.
TEST(Thinning, LeavesAboutOnePointForEachSquareOfAVoxel) {
  constexpr double kVoxel_m = 0.2, kPi = std::numbers::pi;
  for (const double range_m : {1.2, 3.0, 10.0}) {
    std::vector<Feature> features;
    const double step_rad = 0.1 * kVoxel_m / range_m;
    for (double z = -1 + step_rad; z < 1; z += step_rad)
      for (double a = 0; a < 2 * kPi; a += 5 * step_rad) {
        const double level = std::sqrt(1 - z * z);
        const Vec3 p = range_m * Vec3(level * std::cos(a), level * std::sin(a), z);
        features.push_back({p.cast<float>(), {0, 0, 1}, 0});
      }
    const double squares = 4 * kPi * range_m * range_m / (kVoxel_m * kVoxel_m);
    const double kept = static_cast<double>(thin_features(features, kVoxel_m).size());
    EXPECT_GT(kept, 0.6 * squares) << range_m;
    EXPECT_LT(kept, 1.7 * squares) << range_m;
  }
}

// Cubes would keep as many of the points that noise puts beyond their border as of those before it.
TEST(Thinning, DoesNotShiftANoisyWall) {
  constexpr double kNoise_m = 0.03;
  uint64_t state = 1;
  const auto uniform = [&] {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state >> 11) / 9007199254740992.0;
  };
  for (const double wall_m : {2.0, 2.02, 2.05, 2.08}) {
    std::vector<Feature> features;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 on_wall(6 * uniform() - 3, wall_m, uniform() - 0.5);
      const double noise = kNoise_m * (uniform() + uniform() + uniform() - 1.5) * 2;
      features.push_back({(on_wall * (1 + noise / on_wall.norm())).cast<float>(), {1, 0, 0}, 0});
    }
    const auto kept = thin_features(features, 0.1);
    double mean_m = 0;
    for (const Feature& f : kept) mean_m += f.point_lidar.y() / static_cast<double>(kept.size());
    EXPECT_NEAR(mean_m, wall_m, 4 * kNoise_m / std::sqrt(static_cast<double>(kept.size()))) << wall_m;
  }
}

TEST(Thinning, WhileSelectingGivesTheSame) {
  for (const LidarScan& s :
       {scan_at_origin(jambed_corridor(50, 4, 0.15), {}), scan_at_origin(jambed_corridor(50, 4, 0.15))}) {
    const Cloud points_lidar = undistort(s, MotionPath(s.stamp), rig().lidar.T_base_lidar);
    for (double voxel_m : {0.1, 0.2, 0.8}) {
      const auto expected = thin_features(select_planar_features(s, points_lidar, kSigma_m, {}), voxel_m);
      RingOrder order(s, points_lidar, range_step_m(kSigma_m, {}));
      const auto kept = select_thin_features(order, kSigma_m, {}, voxel_m);
      ASSERT_EQ(kept.size(), expected.size());
      ASSERT_GT(kept.size(), 100u);
      for (size_t i = 0; i < kept.size(); ++i) {
        EXPECT_EQ(kept[i].point_lidar, expected[i].point_lidar);
        EXPECT_EQ(kept[i].chord_lidar, expected[i].chord_lidar);
        EXPECT_EQ(kept[i].ring, expected[i].ring);
      }
    }
  }
}

TEST(KeyIndex, NumbersKeysInOrderOfInsertion) {
  KeyIndex index(4);
  std::set<uint64_t> seen;
  for (uint64_t i = 0; i < 5000; ++i) {
    const uint64_t key = (i * 2654435761u) % 1777;
    const int expected_new = static_cast<int>(seen.size());
    const bool is_new = seen.insert(key).second;
    const int number = index.insert(key);
    if (is_new) {
      EXPECT_EQ(number, expected_new);
    }
    EXPECT_EQ(index.find(key), number);
  }
  EXPECT_EQ(index.size(), seen.size());
  EXPECT_EQ(index.find(999999), -1);
}

}  // namespace
}  // namespace vsslam

#include "scenarios/experiment/scan_disturbances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "sensors/lidar/laser_table.h"

namespace vsslam {
namespace {

constexpr double kWall_m = 8;
constexpr float kIntensity = 40;
constexpr size_t kCycles = 1808;

/// A revolution inside a sphere around the LiDAR; every point has a truth whose triangle is the point's number.
LidarMeasurement revolution() {
  const LaserTable& table = laser_table(LidarModel::vlp16);
  LidarMeasurement m;
  m.true_stamp = m.scan.stamp = Time{3'000'000'000};
  for (size_t cycle = 0; cycle < kCycles; ++cycle)
    for (const Laser& laser : table.lasers) {
      const int64_t fired_ns = static_cast<int64_t>(cycle) * table.cycle_ns + laser.fire_offset_ns;
      const double azimuth = -2 * std::numbers::pi * static_cast<double>(cycle) / kCycles;
      m.scan.points.push_back(
          {static_cast<float>(kWall_m * std::cos(laser.elevation_rad) * std::cos(azimuth)),
           static_cast<float>(kWall_m * std::cos(laser.elevation_rad) * std::sin(azimuth)),
           static_cast<float>(kWall_m * std::sin(laser.elevation_rad)), kIntensity, laser.ring,
           static_cast<float>(1e-9 * static_cast<double>(fired_ns))});
      m.truth.push_back({.triangle = static_cast<uint32_t>(m.truth.size())});
      m.scan.end = m.scan.stamp + Duration{fired_ns};
    }
  return m;
}

LidarMeasurement disturbed(const ScanDisturbances& disturbances, uint64_t seed = 1) {
  LidarMeasurement m = revolution();
  LidarConfig lidar;
  lidar.range_sigma_m = 0;
  ScanDisturber(disturbances, lidar, seed).disturb(m);
  return m;
}

double range_m(const LidarPoint& p) {
  return std::sqrt(double{p.x} * p.x + double{p.y} * p.y + double{p.z} * p.z);
}

double share(size_t part, size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

bool same(const LidarPoint& a, const LidarPoint& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.intensity == b.intensity && a.ring == b.ring &&
         a.time_s == b.time_s;
}

bool same(const LidarMeasurement& a, const LidarMeasurement& b) {
  return std::equal(a.scan.points.begin(), a.scan.points.end(), b.scan.points.begin(), b.scan.points.end(),
                    [](const LidarPoint& p, const LidarPoint& q) { return same(p, q); });
}

const ScanDisturbances kAll{.time_jitter_us = 60,
                            .second_return_share = 0.2,
                            .rain_share = 0.05,
                            .mast = {.radius_m = 0.1},
                            .rings = ScanDisturbances::Rings::elevation};

TEST(ScanDisturbances, DefaultsChangeNothing) {
  const LidarMeasurement m = disturbed({});
  EXPECT_TRUE(same(m, revolution()));
  EXPECT_EQ(m.truth.size(), m.scan.points.size());
}

TEST(ScanDisturbances, ASeedGivesThePointsAgainAndAnotherSeedOthers) {
  EXPECT_TRUE(same(disturbed(kAll), disturbed(kAll)));
  EXPECT_FALSE(same(disturbed(kAll), disturbed(kAll, 2)));
}

TEST(ScanDisturbances, JitterIsUniformAndStaysWithinTheScan) {
  const LidarMeasurement before = revolution(), m = disturbed({.time_jitter_us = 60});
  ASSERT_EQ(m.scan.points.size(), before.scan.points.size());
  double sum_us = 0, squares_us2 = 0, most_us = 0;
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    const double off_us = 1e6 * (double{m.scan.points[i].time_s} - double{before.scan.points[i].time_s});
    sum_us += off_us, squares_us2 += off_us * off_us, most_us = std::max(most_us, std::abs(off_us));
    EXPECT_GE(m.scan.points[i].time_s, 0);
    EXPECT_LE(m.scan.points[i].time_s, seconds_between(m.scan.stamp, m.scan.end) + 1e-8);
  }
  const auto count = static_cast<double>(m.scan.points.size());
  EXPECT_LT(most_us, 60.01);
  EXPECT_NEAR(sum_us / count, 0, 1);
  EXPECT_NEAR(squares_us2 / count, 60.0 * 60 / 3, 20);
  EXPECT_EQ(m.truth.size(), m.scan.points.size());
}

TEST(ScanDisturbances, SecondReturnsFollowTheirFirstFurtherAlongTheBeam) {
  const LidarMeasurement m = disturbed({.second_return_share = 0.25});
  const size_t firsts = m.truth.size(), all = m.scan.points.size();
  ASSERT_EQ(firsts, revolution().scan.points.size());
  EXPECT_NEAR(share(all - firsts, firsts), 0.25, 0.01);
  size_t seconds = 0;
  for (size_t i = 1; i < all; ++i) {
    const LidarPoint &first = m.scan.points[i - 1], &second = m.scan.points[i];
    if (range_m(second) < kWall_m + 0.1) continue;
    ++seconds;
    EXPECT_GE(range_m(second), kWall_m + 0.499);
    EXPECT_LE(range_m(second), kWall_m + 5.001);
    EXPECT_EQ(second.ring, first.ring);
    if (i + 1 < all) {
      EXPECT_NEAR(second.time_s - first.time_s, 3e-6, 1.5e-8);
    }
    const double cosine =
        (double{first.x} * second.x + double{first.y} * second.y + double{first.z} * second.z) /
        (range_m(first) * range_m(second));
    EXPECT_NEAR(cosine, 1, 1e-6);
  }
  EXPECT_EQ(seconds, all - firsts);
}

TEST(ScanDisturbances, SecondReturnsEndAtTheLongestRange) {
  LidarMeasurement m = revolution();
  LidarConfig lidar;
  lidar.max_range_m = kWall_m + 1;
  ScanDisturber({.second_return_share = 1}, lidar, 1).disturb(m);
  double furthest_m = 0;
  for (const LidarPoint& point : m.scan.points) furthest_m = std::max(furthest_m, range_m(point));
  EXPECT_NEAR(furthest_m, kWall_m + 1, 1e-4);
}

TEST(ScanDisturbances, RainIsSpreadEvenlyBeforeTheSurfaceAndHasNoTruth) {
  const LidarMeasurement m = disturbed({.rain_share = 0.1});
  ASSERT_EQ(m.scan.points.size(), revolution().scan.points.size());
  const double nearest_m = LidarConfig{}.min_range_m;
  std::set<uint32_t> of_the_world;
  for (const PointTruth& truth : m.truth) of_the_world.insert(truth.triangle);
  double sum_m = 0;
  size_t drops = 0;
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    const bool drop = m.scan.points[i].intensity < kIntensity;
    if (drop) sum_m += range_m(m.scan.points[i]);
    drops += drop;
    EXPECT_GE(range_m(m.scan.points[i]), nearest_m - 1e-4);
    EXPECT_EQ(of_the_world.contains(static_cast<uint32_t>(i)), !drop);
  }
  EXPECT_NEAR(share(drops, m.scan.points.size()), 0.1, 0.01);
  EXPECT_NEAR(sum_m / static_cast<double>(drops), (nearest_m + kWall_m) / 2, 0.15);
}

// A circle of radius r at distance d hides 2 asin(r / d) of the turn, and all points behind it lie on it.
TEST(ScanDisturbances, AMastHidesWhatIsBehindIt) {
  const LidarMeasurement m = disturbed({.mast = {.radius_m = 0.1, .distance_m = 1.2, .azimuth_deg = 150}});
  const double x_m = 1.2 * std::cos(150 * std::numbers::pi / 180),
               y_m = 1.2 * std::sin(150 * std::numbers::pi / 180);
  size_t hidden = 0;
  for (const LidarPoint& point : m.scan.points) {
    if (range_m(point) > kWall_m - 0.01) continue;
    ++hidden;
    EXPECT_NEAR(std::hypot(point.x - x_m, point.y - y_m), 0.1, 1e-5);
  }
  EXPECT_NEAR(share(hidden, m.scan.points.size()), 2 * std::asin(0.1 / 1.2) / (2 * std::numbers::pi),
              1.0 / kCycles);
  EXPECT_EQ(m.truth.size(), m.scan.points.size() - hidden);
}

TEST(ScanDisturbances, RingsAreHiddenGuessedOrDropped) {
  using Rings = ScanDisturbances::Rings;
  const LidarMeasurement before = revolution(), none = disturbed({.rings = Rings::none}),
                         elevation = disturbed({.rings = Rings::elevation}),
                         dropped = disturbed({.rings = Rings::dropped});
  for (const LidarPoint& point : none.scan.points) EXPECT_EQ(point.ring, 0);
  EXPECT_TRUE(same(elevation, before));  // a VLP-16's are spread evenly
  EXPECT_EQ(2 * dropped.scan.points.size(), before.scan.points.size());
  EXPECT_EQ(dropped.truth.size(), dropped.scan.points.size());
  for (const LidarPoint& point : dropped.scan.points) EXPECT_EQ(point.ring % 2, 0);
}

TEST(ScanDisturbances, OneMoreLeavesTheOthersAsTheyWere) {
  ScanDisturbances no_seconds = kAll;
  no_seconds.second_return_share = 0;
  const LidarMeasurement all = disturbed(kAll), fewer = disturbed(no_seconds);
  size_t found = 0;
  for (const LidarPoint& point : all.scan.points)
    if (found < fewer.scan.points.size() && same(point, fewer.scan.points[found])) ++found;
  EXPECT_EQ(found, fewer.scan.points.size());
}

}  // namespace
}  // namespace vsslam

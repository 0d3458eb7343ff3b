#include "scenarios/datasets/export/scan_columns.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vsslam {
namespace {

// `cycles` firing cycles; every seventh firing gives no point. Truth carries the number of its firing.
LidarMeasurement fired(const LaserTable& table, int cycles) {
  LidarMeasurement m;
  uint32_t firing = 0;
  for (int cycle = 0; cycle < cycles; ++cycle)
    for (const Laser& laser : table.lasers) {
      if (++firing % 7 == 0) continue;
      LidarPoint point;
      point.ring = laser.ring;
      point.time_s =
          static_cast<float>(static_cast<double>(cycle * table.cycle_ns + laser.fire_offset_ns) * 1e-9);
      point.x = static_cast<float>(firing);
      m.scan.points.push_back(point);
      PointTruth truth;
      truth.triangle = firing;
      m.truth.push_back(truth);
    }
  return m;
}

class ScanColumns : public testing::TestWithParam<LidarModel> {};
INSTANTIATE_TEST_SUITE_P(Devices, ScanColumns, testing::Values(LidarModel::vlp16, LidarModel::vlp32c));

TEST_P(ScanColumns, AreByRingAndTheLastPointIsTheLatest) {
  const LaserTable& table = laser_table(GetParam());
  constexpr int kCycles = 1800;
  LidarMeasurement m = fired(table, kCycles);
  const LidarMeasurement before = m;
  arrange_in_columns(m, table);
  const auto& points = m.scan.points;
  ASSERT_EQ(points.size(), before.scan.points.size());
  const auto column = [&](const LidarPoint& p) {
    return static_cast<int64_t>(p.time_s * 1e9 + 500) / table.cycle_ns;
  };
  for (size_t i = 1; i < points.size(); ++i) {
    EXPECT_GE(column(points[i]), column(points[i - 1]));
    if (column(points[i]) == column(points[i - 1]) && column(points[i]) < kCycles - 1) {
      EXPECT_GT(points[i].ring, points[i - 1].ring);
    }
  }
  EXPECT_EQ(points.back().time_s,
            std::max_element(points.begin(), points.end(), [](const LidarPoint& a, const LidarPoint& b) {
              return a.time_s < b.time_s;
            })->time_s);
  for (size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(static_cast<uint32_t>(points[i].x), m.truth[i].triangle);
}

TEST(ScanColumnsOfVlp16, SortedByTimeAreAsFired) {
  const LaserTable& table = laser_table(LidarModel::vlp16);
  LidarMeasurement m = fired(table, 50);
  const LidarMeasurement before = m;
  arrange_in_columns(m, table);
  EXPECT_GT(m.scan.points.back().ring, m.scan.points[m.scan.points.size() - 2].ring);
  std::stable_sort(m.scan.points.begin(), m.scan.points.end(),
                   [](const LidarPoint& a, const LidarPoint& b) { return a.time_s < b.time_s; });
  for (size_t i = 0; i < m.scan.points.size(); ++i) EXPECT_EQ(m.scan.points[i].x, before.scan.points[i].x);
}

TEST(ScanColumnsOfNothing, AreNone) {
  LidarMeasurement empty;
  arrange_in_columns(empty, laser_table(LidarModel::vlp16));
  EXPECT_TRUE(empty.scan.points.empty());
}

}  // namespace
}  // namespace vsslam

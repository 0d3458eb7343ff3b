#include "scenarios/stages/descriptor_example.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "slam/loop/scan_context.h"

namespace vsslam {
namespace {

constexpr double kMountHeight_m = 0.5;

// A ring of posts, 2 m high above the ground; scan n has them in a sector of its own.
void add(DescriptorExample& example, int key, bool distinct, bool novel) {
  Cloud points_lidar;
  for (int i = 0; i < 60 + key; ++i) {
    const float angle = 0.1f * static_cast<float>(i);
    points_lidar.emplace_back(5 * std::cos(angle), 5 * std::sin(angle), 1.5f);
  }
  OdometryScan scan;
  scan.points_lidar = share(points_lidar);
  ScanReport report;
  report.key = key;
  report.scan = 10 * key;
  report.memory = MemoryDecision{distinct, novel};
  example.add(scan, report);
}

TEST(DescriptorExample, IsAStoredScanTheNextLikeItAndTheNextStored) {
  DescriptorExample example;
  add(example, 0, true, true);   // nothing like it follows
  add(example, 1, true, true);   // the first
  add(example, 2, false, true);  // a similar scene
  add(example, 3, true, false);  // the second
  add(example, 4, true, false);
  EXPECT_EQ(nlohmann::json::parse(example.json(kMountHeight_m, {}))["scans"].size(), 2u);
  add(example, 5, true, true);  // the third
  add(example, 6, true, true);
  const auto scans = nlohmann::json::parse(example.json(kMountHeight_m, {}))["scans"];
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_EQ(scans[0]["key"], 1);
  EXPECT_EQ(scans[1]["key"], 3);
  EXPECT_EQ(scans[2]["key"], 5);
  EXPECT_EQ(scans[1]["scan"], 30);
  EXPECT_EQ(scans[1]["stored"], false);
  EXPECT_EQ(scans[2]["stored"], true);
  EXPECT_NEAR(scans[0]["distance"].get<double>(), 0, 1e-5);
  EXPECT_EQ(scans[0]["heights_cm"].size(), 1200u);
  EXPECT_EQ(scans[0]["heights_cm"][2 * 60], 200);  // 5 m away: the third ring of 2 m each
  EXPECT_EQ(scans[0]["points_lidar_cm"].size(), 3 * 61u);
  EXPECT_EQ(scans[0]["points_lidar_cm"][0], 500);
}

TEST(DescriptorExample, IsEmptyWithoutAScanThatWasNotStored) {
  DescriptorExample example;
  EXPECT_EQ(example.json(kMountHeight_m, {}), "");
  add(example, 0, true, true);
  add(example, 1, true, true);
  EXPECT_EQ(example.json(kMountHeight_m, {}), "");
}

}  // namespace
}  // namespace vsslam

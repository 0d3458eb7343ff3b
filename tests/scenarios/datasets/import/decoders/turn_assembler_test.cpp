#include "scenarios/datasets/import/decoders/turn_assembler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vsslam {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Part `i` of a LiDAR that turns clockwise once in 0.1 s, in `parts` parts: 720 / parts columns at 10 m.
LidarScan part(int i, int parts) {
  const Time stamp{1'000'000'000 + static_cast<int64_t>(i) * 100'000'000 / parts};
  LidarScan scan{.stamp = stamp, .end = stamp, .points = {}};
  const int columns = 720 / parts;
  for (int k = 0; k < columns; ++k) {
    const double azimuth_rad = -kTurn * (i * columns + k) / 720.0;
    scan.points.push_back({.x = static_cast<float>(10 * std::cos(azimuth_rad)),
                           .y = static_cast<float>(10 * std::sin(azimuth_rad)),
                           .time_s = static_cast<float>(0.1 * k / 720.0)});
  }
  scan.end = stamp + Duration::from_seconds(static_cast<double>(scan.points.back().time_s));
  return scan;
}

TEST(Turns, PartsAreToldFromTurns) {
  for (const int parts : {2, 3, 4, 10, 72}) {
    std::vector<LidarScan> clouds;
    for (int i = 0; i < 24; ++i) clouds.push_back(part(i, parts));
    const auto found = parts_of_turns(clouds);
    ASSERT_TRUE(found) << parts;
    EXPECT_NEAR(found->every_s, 0.1 / parts, 1e-6);
    EXPECT_NEAR(found->turn_s, 0.1, 0.005);
  }
  std::vector<LidarScan> turns, ahead;
  for (int i = 0; i < 24; ++i) turns.push_back(part(i, 1)), ahead.push_back(part(0, 4));
  EXPECT_FALSE(parts_of_turns(turns));
  EXPECT_FALSE(parts_of_turns(ahead));  // a LiDAR that looks one way
  EXPECT_FALSE(parts_of_turns({}));
}

TEST(Turns, AreWholeAndMissNothing) {
  for (const int parts : {2, 3, 4, 10, 72}) {
    TurnAssembler assembler;
    std::vector<LidarScan> turns;
    for (int i = 0; i < 5 * parts; ++i)
      if (auto turn = assembler.add(part(i, parts))) turns.push_back(std::move(*turn));
    if (auto turn = assembler.rest()) turns.push_back(std::move(*turn));
    ASSERT_EQ(turns.size(), 5u) << parts;
    for (size_t t = 0; t < turns.size(); ++t) {
      EXPECT_EQ(turns[t].stamp, part(static_cast<int>(t) * parts, parts).stamp);
      EXPECT_EQ(turns[t].end, part(static_cast<int>(t + 1) * parts - 1, parts).end);
      ASSERT_EQ(turns[t].points.size(), static_cast<size_t>(720 / parts * parts)) << parts;
      for (size_t k = 0; k < turns[t].points.size(); ++k)
        ASSERT_NEAR(turns[t].points[k].time_s, 0.1 * static_cast<double>(k) / 720, 1e-5);
    }
    EXPECT_EQ(assembler.broken(), 0);
  }
}

TEST(Turns, WithAHoleAreLeftOut) {
  TurnAssembler assembler;
  int turns = 0;
  for (int i = 0; i < 40; ++i)
    if (i < 14 || i > 25) turns += assembler.add(part(i, 4)).has_value();
  EXPECT_EQ(turns, 6);
  EXPECT_EQ(assembler.broken(), 1);
}

}  // namespace
}  // namespace vsslam

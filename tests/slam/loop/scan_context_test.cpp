#include "slam/loop/scan_context.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/rng.h"
#include "slam/loop/loop_detector.h"
#include "tests/slam/loop/loop_room.h"

namespace vsslam {
namespace {

constexpr double kMountHeight = 0.6;

// The definition, word by word: every shift, every column, in double.
ShiftedDistance literal_distance(const PolarHeights& query, const PolarHeights& stored) {
  ShiftedDistance best;
  for (int shift = 0; shift < kSectors; ++shift) {
    double sum = 0;
    int pairs = 0;
    for (int j = 0; j < kSectors; ++j) {
      const Eigen::VectorXd a = query.col(j).cast<double>(),
                            b = stored.col((j + shift) % kSectors).cast<double>();
      if (a.norm() == 0 || b.norm() == 0) continue;
      sum += 1 - a.dot(b) / (a.norm() * b.norm());
      ++pairs;
    }
    const double distance = pairs < kSectors / 2 ? 1.0 : sum / pairs;
    if (distance < best.distance) best = {distance, shift};
  }
  return best;
}

PolarHeights random_heights(uint64_t seed, double empty_share) {
  const RandomStream stream(seed, "heights");
  PolarHeights heights;
  for (int j = 0; j < kSectors; ++j) {
    const auto column = static_cast<uint64_t>(j);
    const bool empty = stream.uniform(column, 100) < empty_share;
    for (int i = 0; i < kRings; ++i) {
      const auto ring = static_cast<uint64_t>(i);
      const bool bare = stream.uniform(column, 200 + ring) < 0.3;
      heights(i, j) = empty || bare ? 0.0f : static_cast<float>(3 * stream.uniform(column, ring));
    }
  }
  return heights;
}

PolarHeights rotated(const PolarHeights& heights, int columns) {
  PolarHeights out;
  for (int j = 0; j < kSectors; ++j) out.col((j + columns) % kSectors) = heights.col(j);
  return out;
}

TEST(ScanContext, PointsFallIntoTheCellsOfTheDefinition) {
  const ScanContextConfig config{.max_range_m = 40};  // rings of 2 m
  const auto cell_of = [&](float x, float y) {
    const PolarHeights heights = polar_heights({{x, y, 0.4f}}, kMountHeight, config);
    Eigen::Index ring = -1, sector = -1;
    EXPECT_FLOAT_EQ(heights.maxCoeff(&ring, &sector), 1.0f);
    return std::pair<int, int>(static_cast<int>(ring), static_cast<int>(sector));
  };
  EXPECT_EQ(cell_of(1, 0.01f), std::pair(0, 0));
  EXPECT_EQ(cell_of(0, 0), std::pair(0, 0));
  EXPECT_EQ(cell_of(2, 0), std::pair(0, 0));  // ceil: a ring ends with its outer edge
  EXPECT_EQ(cell_of(2.01f, 0), std::pair(1, 0));
  EXPECT_EQ(cell_of(40, 0), std::pair(19, 0));
  EXPECT_EQ(cell_of(0.01f, 5), std::pair(2, 14));
  EXPECT_EQ(cell_of(-0.01f, 5), std::pair(2, 15));
  EXPECT_EQ(cell_of(5, -0.01f), std::pair(2, 59));
  EXPECT_TRUE(polar_heights({{40.01f, 0, 1}}, kMountHeight, config).isZero());
}

TEST(ScanContext, SectorsAreThoseOfAtan2ToTheLastPoint) {
  const ScanContextConfig config{.max_range_m = 200};
  const RandomStream stream(11, "points");
  const auto expect_sector = [&](float x, float y) {
    const float theta = std::atan2(y, x);
    const float turn = theta < 0 ? theta + 2 * std::numbers::pi_v<float> : theta;
    const int sector =
        std::clamp(static_cast<int>(std::ceil(turn * (30 / std::numbers::pi_v<float>))), 1, kSectors) - 1;
    Eigen::Index row = -1, column = -1;
    polar_heights({{x, y, 1}}, kMountHeight, config).maxCoeff(&row, &column);
    ASSERT_EQ(column, sector) << x << " " << y;
  };
  for (uint64_t i = 0; i < 20000; ++i)
    expect_sector(static_cast<float>(20 * stream.normal(i, 0)), static_cast<float>(5 * stream.normal(i, 1)));
  for (int border = -60; border <= 60; ++border)  // each border, on it and a few last digits beside it
    for (int digits = -20; digits <= 20; ++digits) {
      const float angle =
          static_cast<float>(border) * std::numbers::pi_v<float> / 30 + static_cast<float>(digits) * 2e-7f;
      expect_sector(7 * std::cos(angle), 7 * std::sin(angle));
    }
  for (const float zero : {0.0f, -0.0f}) {
    expect_sector(zero, zero);
    for (const float one : {1.0f, -1.0f}) {
      expect_sector(zero, one);
      expect_sector(one, zero);
      expect_sector(one, 1e-30f * one);
    }
  }
}

TEST(ScanContext, CellsHoldTheHighestPointAboveGround) {
  const ScanContextConfig config;
  const PolarHeights heights =
      polar_heights({{3, 1, -0.2f}, {3, 1, 1.0f}, {3, 1, 0.5f}, {-3, 1, -5.0f}}, kMountHeight, config);
  EXPECT_FLOAT_EQ(heights.maxCoeff(), 1.6f);
  EXPECT_EQ((heights.array() != 0).count(), 1);  // below ground counts as empty
}

TEST(ScanContext, KeysAreMeans) {
  const PolarHeights heights = random_heights(1, 0.2);
  const ScanContext context(heights);
  for (int i = 0; i < kRings; ++i) EXPECT_NEAR(context.ring_key[i], heights.row(i).sum() / kSectors, 1e-5);
  for (int j = 0; j < kSectors; ++j) {
    EXPECT_NEAR(context.sector_key[j], heights.col(j).sum() / kRings, 1e-5);
    EXPECT_EQ((context.occupied >> j & 1) == 1, heights.col(j).any());
  }
}

TEST(ScanContext, FastDistanceIsTheDefinition) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const double empty = 0.02 * static_cast<double>(seed);
    const PolarHeights a = random_heights(2 * seed, empty), b = random_heights(2 * seed + 1, empty);
    for (const PolarHeights& other : {b, rotated(a, static_cast<int>(seed)), a}) {
      const ShiftedDistance fast = scan_context_distance(ScanContext(a), ScanContext(other));
      const ShiftedDistance literal = literal_distance(a, other);
      EXPECT_NEAR(fast.distance, literal.distance, 2e-6) << seed;
      EXPECT_EQ(fast.shift, literal.shift) << seed;
    }
  }
}

TEST(ScanContext, EmptyColumnsAreLeftOutExactly) {
  PolarHeights a = PolarHeights::Zero(), b = PolarHeights::Zero();
  for (int j = 0; j < 30; ++j) a(3, j) = b(3, j) = 2;
  for (int j = 30; j < 60; ++j) b(5, j) = 2;  // opposite empty columns of a
  EXPECT_NEAR(scan_context_distance(ScanContext(a), ScanContext(b)).distance, 0, 1e-6);
  // One pair less than half: no distance at any shift, however alike.
  a.col(29).setZero();
  EXPECT_EQ(scan_context_distance(ScanContext(a), ScanContext(b)).distance, 1.0);
  EXPECT_EQ(scan_context_distance(ScanContext(), ScanContext()).distance, 1.0);
}

TEST(ScanContext, RotatedGridHasDistanceZeroAtItsShift) {
  const PolarHeights heights = random_heights(9, 0.1);
  for (int columns : {0, 1, 17, 30, 31, 59}) {
    const ShiftedDistance d =
        scan_context_distance(ScanContext(heights), ScanContext(rotated(heights, columns)));
    EXPECT_NEAR(d.distance, 0, 1e-6);
    EXPECT_EQ(d.shift, columns);
  }
  EXPECT_NEAR((ShiftedDistance{0, 30}.yaw_rad()), M_PI, 1e-12);
  EXPECT_NEAR((ShiftedDistance{0, 31}.yaw_rad()), -29 * M_PI / 30, 1e-12);
}

TEST(ScanContext, YawOfTheShiftIsTheYawOfTheQueryInTheStoredFrame) {
  const TestRoom room = cluttered_room();
  const SE3 T_map_match = planar(2, 1, 0.3, kMountHeight);
  const ScanContext stored(polar_heights(scan_room(room, T_map_match), kMountHeight, {}));
  for (double yaw_deg : {0.0, 60.0, 100.0, 174.0, -90.0, -30.0}) {
    const SE3 T_match_query = planar(0, 0, yaw_deg * M_PI / 180);
    const ScanContext query(polar_heights(scan_room(room, T_map_match * T_match_query), kMountHeight, {}));
    const ShiftedDistance d = scan_context_distance(query, stored);
    EXPECT_LT(d.distance, 0.1) << yaw_deg;
    const SE3 guess = guess_from_descriptor(d.yaw_rad(), {0, 0}, SE3());
    EXPECT_LT((guess.inverse() * T_match_query).angle(), 6.1 * M_PI / 180) << yaw_deg;
  }
}

TEST(ScanContext, AVirtualPositionSeesTheCloudFromThere) {
  // The query stands 2 m to the side of the match; seen from the virtual position it looks the same.
  const TestRoom room = cluttered_room();
  const SE3 T_map_match = planar(1, -2, -1.0, kMountHeight), T_match_query = planar(-1.2, 1.6, 0.9);
  const Cloud match = scan_room(room, T_map_match), query = scan_room(room, T_map_match * T_match_query);
  const Vec3 match_in_query = T_match_query.inverse().translation;
  const ScanContext stored(polar_heights(match, kMountHeight, {}));
  const ShiftedDistance real =
      scan_context_distance(ScanContext(polar_heights(query, kMountHeight, {})), stored);
  const ShiftedDistance there = scan_context_distance(
      ScanContext(polar_heights(query, kMountHeight, {}, match_in_query.head<2>())), stored);
  EXPECT_LT(there.distance, 0.8 * real.distance);
  const SE3 guess = guess_from_descriptor(there.yaw_rad(), match_in_query.head<2>(), SE3());
  EXPECT_LT((guess.inverse() * T_match_query).angle(), 6.1 * M_PI / 180);
  EXPECT_LT((guess.translation - T_match_query.translation).norm(), 2 * 6.1 * M_PI / 180);
}

}  // namespace
}  // namespace vsslam

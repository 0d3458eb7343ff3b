#include "slam/lidar/patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vsslam {
namespace {

// A grid of n x n points, `length_m` x `width_m`, alternately `thickness_m` above and below the plane z = 0, turned
// and moved.
Patch grid(int n, double length_m, double width_m, double thickness_m, const SE3& pose = {}) {
  Vec3 mean = Vec3::Zero();
  Mat3 square = Mat3::Zero();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double above = (i + j) % 2 == 0 ? thickness_m : -thickness_m;
      const Vec3 p = pose * Vec3(length_m * (i / (n - 1.0) - 0.5), width_m * (j / (n - 1.0) - 0.5), above);
      mean += p / (n * n);
      square += p * p.transpose() / (n * n);
    }
  return {mean, square, static_cast<double>(n * n)};
}

TEST(Patch, NormalAndSpreadOfAGrid) {
  Vec6 motion;
  motion << 0.3, -0.2, 1.1, 2.0, -3.0, 0.5;
  const SE3 pose = SE3::exp(motion);
  const Patch patch = grid(4, 0.6, 0.3, 0.01, pose);
  EXPECT_NEAR(std::abs(patch.normal.dot(pose.rotation * Vec3::UnitZ())), 1, 1e-6);
  // Variance of n evenly spaced values over a length l: l^2 / 12 * (n + 1) / (n - 1).
  EXPECT_NEAR(patch.spread_m2[2], 0.36 / 12 * 5 / 3, 1e-3);
  EXPECT_NEAR(patch.spread_m2[1], 0.09 / 12 * 5 / 3, 1e-3);
  EXPECT_NEAR(patch.spread_m2[0], 1e-4, 1e-5);
}

TEST(Patch, ANormalIsKnownFromEnoughPointsSpreadWideEnough) {
  // sigma / sqrt(count * spread): 0.01 / sqrt(16 * 0.0125) = 0.0224 rad.
  const Patch patch = grid(4, 0.6, 0.3, 0.01);
  EXPECT_TRUE(patch.normal_is_known(0.0235, 0.007));
  EXPECT_FALSE(patch.normal_is_known(0.0215, 0.007));
  // A thin patch is not believed better than its range noise: 0.02 / sqrt(16 * 0.0125) = 0.0447 rad.
  const Patch thin = grid(4, 0.6, 0.3, 1e-4);
  EXPECT_TRUE(thin.normal_is_known(0.046, 0.02));
  EXPECT_FALSE(thin.normal_is_known(0.043, 0.02));
}

TEST(Patch, ALineHasNoNormal) {
  EXPECT_FALSE(grid(4, 0.6, 0.0, 0.001).normal_is_known(0.05, 0.007));
}

}  // namespace
}  // namespace vsslam

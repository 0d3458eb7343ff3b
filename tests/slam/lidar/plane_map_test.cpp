#include "slam/lidar/plane_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vsslam {
namespace {

// A wall along x at y = 3 with door leaves, 0.9 m of every 3 m, 15 cm deeper.
bool is_door(float x) {
  return std::fmod(x, 3.0f) > 1.0f && std::fmod(x, 3.0f) < 1.9f;
}

PlaneMap map_of_a_wall_with_doors(double range_sigma_m) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, static_cast<float>(range_sigma_m));
  std::vector<MapPoint> points;
  for (uint32_t line = 0; line < 12; ++line)
    for (float x = 0.1f; x < 24; x += 0.1f)
      points.push_back({{x, (is_door(x) ? 3.15f : 3.0f) + noise(random), 0.2f * static_cast<float>(line)}, {0.5f, 0, 0}, line});
  PlaneMap map({});
  map.rebuild({points}, range_sigma_m);
  return map;
}

// Together they scatter by 8 cm about a plane 3 to 5 cm off the wall, which is less than twice the noise of a cheap LiDAR.
TEST(PlaneMap, AWallAndTheDoorsInItAreDifferentPlanesAtAnyNoise) {
  for (const double sigma_m : {0.003, 0.007, 0.03, 0.05}) {
    const PlaneMap map = map_of_a_wall_with_doors(sigma_m);
    double wall_off_m = 0;
    int found = 0, asked = 0;
    for (float x = 0.3f; x < 23.5f; x += 0.1f) {
      if (is_door(x - 0.2f) || is_door(x + 0.2f)) continue;
      ++asked;
      const Eigen::Vector3f on_wall(x, 3, 1);
      const Plane* plane = map.find(on_wall, {0.5f, 0, 0});
      if (plane == nullptr) continue;
      ++found;
      wall_off_m += std::abs(plane->normal_odom.dot(on_wall) - plane->distance_m);
    }
    EXPECT_GT(found, asked / 2) << sigma_m;
    EXPECT_LT(wall_off_m / found, 0.003 + 0.2 * sigma_m) << sigma_m;
  }
}

// The shortest chord of a feature is five times the noise.
TEST(PlaneMap, AChordAtRightAnglesIsAnotherSurface) {
  for (const double sigma_m : {0.007, 0.05}) {
    const PlaneMap map = map_of_a_wall_with_doors(sigma_m);
    const auto shortest_m = static_cast<float>(5 * sigma_m);
    EXPECT_NE(map.find({6, 3, 1}, {shortest_m, 0, 0}), nullptr) << sigma_m;
    EXPECT_EQ(map.find({6, 3, 1}, {0, shortest_m, 0}), nullptr) << sigma_m;
  }
}

}  // namespace
}  // namespace vsslam

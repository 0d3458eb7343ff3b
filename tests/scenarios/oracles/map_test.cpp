#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/rng.h"
#include "scenarios/oracles/map_error.h"

namespace vsslam {
namespace {

World triangles(const std::vector<std::array<Vec3f, 3>>& corners) {
  World world;
  world.materials.resize(1);
  Primitive primitive;
  for (const auto& triangle : corners) {
    const auto first = static_cast<uint32_t>(primitive.positions.size());
    primitive.positions.insert(primitive.positions.end(), triangle.begin(), triangle.end());
    primitive.triangles.push_back({first, first + 1, first + 2});
  }
  world.meshes.push_back({.name = "m", .primitives = {primitive}});
  world.objects.emplace_back().name = "object";
  return world;
}

TEST(SurfaceDistance, EveryRegionOfATriangle) {
  const SurfaceDistance distance(triangles({{Vec3f(0, 0, 0), Vec3f(4, 0, 0), Vec3f(0, 3, 0)}}));
  EXPECT_NEAR(distance({1, 1, 2}), 2, 1e-12);               // above the face
  EXPECT_NEAR(distance({1, 1, -2}), 2, 1e-12);              // below it
  EXPECT_NEAR(distance({-3, -4, 0}), 5, 1e-12);             // corner a
  EXPECT_NEAR(distance({7, -4, 0}), 5, 1e-12);              // corner b
  EXPECT_NEAR(distance({-3, 7, 0}), 5, 1e-12);              // corner c
  EXPECT_NEAR(distance({2, -3, 4}), 5, 1e-12);              // edge ab
  EXPECT_NEAR(distance({-3, 1, 4}), 5, 1e-12);              // edge ac
  EXPECT_NEAR(distance({2 + 0.6, 1.5 + 0.8, 0}), 1, 1e-6);  // edge bc, along its normal (3, 4) / 5
  EXPECT_NEAR(distance({1, 1, 0}), 0, 1e-12);
}

TEST(SurfaceDistance, TheTreeFindsWhatAFullSearchFinds) {
  const RandomStream random(3, "triangles");
  std::vector<std::array<Vec3f, 3>> corners;
  std::vector<SurfaceDistance> single;
  for (uint64_t i = 0; i < 300; ++i) {
    std::array<Vec3f, 3> triangle;
    for (uint64_t k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis)
        triangle[k][axis] = static_cast<float>(10 * random.uniform(i, static_cast<uint64_t>(axis)) +
                                               random.normal(1000 + i, 3 * k + static_cast<uint64_t>(axis)));
    corners.push_back(triangle);
    single.emplace_back(triangles({triangle}));
  }
  const SurfaceDistance all(triangles(corners));
  for (uint64_t i = 0; i < 200; ++i) {
    const Vec3 p =
        14 * Vec3(random.uniform(5000 + i, 0), random.uniform(5000 + i, 1), random.uniform(5000 + i, 2));
    double best = std::numeric_limits<double>::infinity();
    for (const SurfaceDistance& one : single) best = std::min(best, one(p));
    EXPECT_NEAR(all(p), best, 1e-12);
  }
}

TEST(SurfaceDistance, PlacesObjects) {
  World world = triangles({{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}});
  world.objects[0].T_world_object = Eigen::Translation3d(0, 0, 5) * Eigen::Affine3d::Identity();
  EXPECT_NEAR(SurfaceDistance(world)({0.2, 0.2, 0}), 5, 1e-12);
  world.objects.clear();
  EXPECT_EQ(SurfaceDistance(world)({0, 0, 0}), std::numeric_limits<double>::infinity());
}

TEST(MapError, IsTheMeanDistanceAfterAlignment) {
  const World floor = triangles({{Vec3f(-100, -100, 0), Vec3f(300, -100, 0), Vec3f(-100, 300, 0)}});
  const SurfaceDistance surface(floor);
  Cloud map;
  for (int i = 0; i < 1000; ++i)
    map.emplace_back(0.1f * static_cast<float>(i % 40), 0.0f, i % 2 == 0 ? 1.0f : 1.2f);
  const SE3 T_world_map(Quat::Identity(), {0, 0, -1});
  const MapError error = map_error(map, T_world_map, surface);
  EXPECT_NEAR(error.mean_m, 0.1, 1e-7);
  EXPECT_NEAR(error.max_m, 0.2, 1e-6);
  EXPECT_EQ(error.points, 1000u);
  EXPECT_LE(map_error(map, T_world_map, surface, 300).points, 300u);
  EXPECT_GE(map_error(map, T_world_map, surface, 300).points, 200u);
  EXPECT_EQ(map_error({}, T_world_map, surface).points, 0u);
}

}  // namespace
}  // namespace vsslam

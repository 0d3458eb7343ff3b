#include "worlds/indoor/room.h"

#include <gtest/gtest.h>

#include "tests/worlds/geometry.h"
#include "worlds/route.h"

namespace vsslam {
namespace {

TEST(Room, ShellIsClosed) {
  RoomConfig config;
  config.textures = false;
  config.floor_unevenness_m = 0.005;
  std::vector<WorldTriangle> shell;
  for (const WorldTriangle& t : triangles_of(make_room(config)))
    if (t.object < 3) shell.push_back(t);
  EXPECT_EQ(open_edges(shell), 0u);
}

TEST(Room, LoopKeepsItsDistanceFromEverything) {
  for (const double clutter : {0.0, 0.5, 1.0}) {
    RoomConfig config;
    config.textures = false;
    config.clutter = clutter;
    const World world = make_room(config);
    const Route& loop = world.routes.front();
    EXPECT_EQ(loop.name, "loop");
    EXPECT_TRUE(loop.closed);
    EXPECT_GT(route_length_m(loop), 20);
    const auto triangles = triangles_of(world);
    for (size_t i = 0; i < loop.points_world.size(); ++i) {
      const Vec3& a = loop.points_world[i];
      const Vec3& b = loop.points_world[(i + 1) % loop.points_world.size()];
      EXPECT_GE(clearance_m(triangles, 0.5 * (a + b), 0.02, 1.5), 0.8) << a.transpose();
      EXPECT_LE((a - b).norm(), 0.5 + 1e-9);
    }
  }
}

TEST(Room, FurnitureStandsClear) {
  RoomConfig config;
  config.textures = false;
  const World world = make_room(config);
  EXPECT_GE(world.objects.size(), 3u + 10u);
  for (size_t i = 3; i < world.objects.size(); ++i) {
    const Vec3 at = world.objects[i].T_world_object.translation();
    EXPECT_LT(std::abs(at.x()), config.length_m / 2);
    EXPECT_LT(std::abs(at.y()), config.width_m / 2);
    for (size_t k = i + 1; k < world.objects.size(); ++k)
      EXPECT_GT((at - world.objects[k].T_world_object.translation()).norm(), 0.5);
  }
}

}  // namespace
}  // namespace vsslam

#include "sensors/ray/raycaster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/ordered_parallel.h"
#include "sensors/lidar/firing_poses.h"
#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

/// Rays from `origin` in a fan of directions.
RayPacket fan(const Vec3& origin, double first_rad, double step_rad) {
  RayPacket rays;
  for (int i = 0; i < 16; ++i) {
    const double a = first_rad + i * step_rad;
    rays.origin_x[i] = static_cast<float>(origin.x());
    rays.origin_y[i] = static_cast<float>(origin.y());
    rays.origin_z[i] = static_cast<float>(origin.z());
    rays.direction_x[i] = static_cast<float>(std::cos(a));
    rays.direction_y[i] = static_cast<float>(std::sin(a));
    rays.direction_z[i] = 0;
    rays.near_m[i] = 0;
    rays.far_m[i] = 100;
  }
  return rays;
}

TEST(Raycaster, RangesAreExactFarFromTheOrigin) {
  const Vec3 origin(50, 40, 1);
  const World world = shapes::room_world(origin - Vec3(30, 5, 1), origin + Vec3(5, 7, 2));
  const Raycaster raycaster(world);
  const RayPacket rays = fan(origin, -0.5, 0.06);
  HitPacket hits;
  raycaster.trace({&rays, 1}, {&hits, 1});
  for (int i = 0; i < 16; ++i) {
    const double expected = 5.0 / static_cast<double>(rays.direction_x[i]);
    EXPECT_NEAR(hits.range_m[i], expected, 1e-5);
    EXPECT_EQ(hits.object[i], 0u);
    EXPECT_EQ(hits.normal_x[i], -1);
    Raycaster::Hit hit;
    ASSERT_TRUE(raycaster.trace_one(origin, Vec3(rays.direction_x[i], rays.direction_y[i], 0), 100, hit));
    EXPECT_NEAR(hit.range_m, hits.range_m[i], 1e-6);
    EXPECT_EQ(hit.triangle, hits.triangle[i]);
    EXPECT_NEAR((hit.normal_world + Vec3::UnitX()).norm(), 0, 1e-9);
  }
}

TEST(Raycaster, ARayThatIsOffOrMissesHitsNothing) {
  World world;
  world.materials = {shapes::paint(0.5f)};
  shapes::add(world, shapes::wall({5, 0, 0}, {-1, 0, 0}, 2), "wall", 0);
  shapes::add(world, Primitive{}, "nothing", 0);
  const Raycaster raycaster(world);
  RayPacket rays = fan(Vec3::Zero(), 0, 0.001);
  rays.far_m[3] = -1;
  rays.far_m[4] = 4.9f;
  rays.near_m[5] = 5.1f;
  HitPacket hits;
  raycaster.trace({&rays, 1}, {&hits, 1});
  for (int i = 0; i < 16; ++i) EXPECT_EQ(hits.object[i] == HitPacket::kNoHit, i >= 3 && i <= 5) << i;
  Raycaster::Hit hit;
  EXPECT_FALSE(raycaster.trace_one({0, 0, 0}, {-1, 0, 0}, 100, hit));
  const World empty;
  EXPECT_FALSE(Raycaster(empty).trace_one({0, 0, 0}, {1, 0, 0}, 100, hit));
}

TEST(Raycaster, TrianglesAndMaterialsCountThroughPrimitives) {
  World world;
  world.materials = {shapes::paint(0.1f), shapes::paint(0.2f)};
  shapes::add(world, shapes::quad({5, -1, -1}, {0, 1, 0}, {0, 0, 2}), "two", 0);
  Primitive right = shapes::quad({5, 0, -1}, {0, 1, 0}, {0, 0, 2});
  right.material = 1;
  world.meshes[0].primitives.push_back(right);
  world.objects[0].T_world_object.translate(Vec3(1, 0, 0));
  const Raycaster raycaster(world);
  Raycaster::Hit hit;
  ASSERT_TRUE(raycaster.trace_one({0, -0.5, 0.1}, {1, 0, 0}, 100, hit));
  EXPECT_NEAR(hit.range_m, 6, 1e-6);
  EXPECT_EQ(hit.material, 0);
  EXPECT_LT(hit.triangle, 2u);
  ASSERT_TRUE(raycaster.trace_one({0, 0.5, 0.1}, {1, 0, 0}, 100, hit));
  EXPECT_EQ(hit.material, 1);
  EXPECT_GE(hit.triangle, 2u);
  EXPECT_EQ(raycaster.material(0, 3), 1);
}

TEST(Raycaster, ObjectsMoveAndVanish) {
  World world;
  world.materials = {shapes::paint(0.5f)};
  shapes::add(world, shapes::wall({9, 0, 0}, {-1, 0, 0}, 4), "wall", 0);
  const int door = shapes::add(world, shapes::wall({5, 0, 0}, {-1, 0, 0}, 2), "door", 0);
  Raycaster raycaster(world);
  const auto range = [&] {
    Raycaster::Hit hit;
    EXPECT_TRUE(raycaster.trace_one({0, 0, 0.1}, {1, 0, 0}, 100, hit));
    const RayPacket rays = fan({0, 0, 0.1}, 0, 0);
    HitPacket hits;
    raycaster.trace({&rays, 1}, {&hits, 1});
    EXPECT_NEAR(hits.range_m[7], hit.range_m, 1e-6);
    EXPECT_EQ(hits.object[7], hit.object);
    return hit.range_m;
  };
  EXPECT_NEAR(range(), 5, 1e-6);
  Eigen::Affine3d moved = Eigen::Affine3d::Identity();
  moved.translate(Vec3(-2, 0, 0));
  raycaster.set_object_pose(door, moved, true);
  raycaster.commit();
  EXPECT_NEAR(range(), 3, 1e-6);
  raycaster.set_object_pose(door, moved, false);
  raycaster.commit();
  EXPECT_NEAR(range(), 9, 1e-6);
  raycaster.set_object_pose(door, Eigen::Affine3d::Identity(), true);
  raycaster.commit();
  EXPECT_NEAR(range(), 5, 1e-6);
}

// Embree's own setting of threads would bound those of the whole process.
TEST(Raycaster, LeavesTheOthersTheirThreads) {
  const int before = thread_count();
  set_thread_count(2);
  const World world = shapes::room_world(Vec3(-5, -5, 0), Vec3(5, 5, 3));
  const Raycaster raycaster(world);
  EXPECT_EQ(thread_count(), 2);
  set_thread_count(before);
}

TEST(FiringPoses, StayWithinAMicrometreOfTheSpline) {
  const Trajectory trajectory = shapes::along(shapes::lively, 2);
  const SE3 T_base_lidar = SE3::from_rpy({0.1, 0.2, 0.3}, {0.3, 0.1, 0.5});
  double worst_m = 0, worst_rad = 0;
  for (int64_t begin_ns = 0; begin_ns < 1'900'000'000; begin_ns += 7'777'777) {
    const Time begin{begin_ns}, end{begin_ns + 864'000};
    const FiringPoses poses = FiringPoses::fit(trajectory, T_base_lidar, begin, end);
    for (int64_t ns = 0; ns <= 864'000; ns += 54'000) {
      const double s = (static_cast<double>(ns) - poses.mid_ns) / poses.half_ns;
      const SE3 truth = trajectory.pose(begin + Duration{ns}) * T_base_lidar;
      const auto& R = poses.R_world_lidar;
      const auto& p = poses.p_world_lidar;
      worst_m = std::max(worst_m, (p[0] + s * (p[1] + s * p[2]) - truth.translation).norm());
      worst_rad = std::max(worst_rad, (R[0] + s * (R[1] + s * R[2]) - truth.matrix3()).norm());
    }
  }
  EXPECT_LT(worst_m, 1e-8);
  EXPECT_LT(worst_rad, 1e-8);  // 1e-6 m at 100 m
}

}  // namespace
}  // namespace vsslam

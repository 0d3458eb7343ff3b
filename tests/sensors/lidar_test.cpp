#include "sensors/lidar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/ordered_parallel.h"
#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

LidarMeasurement first_scan(const World& world, const LidarConfig& config, const Trajectory& trajectory,
                            const SE3& T_base_lidar = SE3(), uint64_t seed = 1, int skip = 0,
                            const SensorEvents& events = {}) {
  const Raycaster raycaster(world);
  Lidar lidar(config, events, seed, raycaster);
  Revolution revolution = lidar.power_on(Time{0});
  for (int i = 0; i < skip; ++i) revolution = lidar.after(revolution);
  return lidar.scan(revolution, trajectory, T_base_lidar);
}

TEST(Lidar, WallAtFiveMetres) {
  // 50 m from the origin, so that the rounding of coordinates shows.
  const Vec3 origin(50, -30, 2);
  World world;
  world.materials = {shapes::paint(0.5f)};
  shapes::add(world, shapes::wall(origin + Vec3(5, 0, 0), {-1, 0, 0}, 60), "wall", 0);
  const Trajectory rest = shapes::at_rest(SE3(Quat::Identity(), origin), 1);
  const LidarMeasurement m = first_scan(world, LidarConfig::ideal(), rest);
  ASSERT_GT(m.scan.points.size(), 10000u);
  for (size_t i = 0; i < m.scan.points.size(); ++i) {
    EXPECT_NEAR(m.scan.points[i].x, 5, 1e-5 * (1 + m.truth[i].range_m / 10));
    EXPECT_NEAR(m.truth[i].position_lidar.x(), 5, 1e-5 * (1 + m.truth[i].range_m / 10));
    EXPECT_NEAR((m.truth[i].normal_lidar - Vec3f(-1, 0, 0)).norm(), 0, 1e-6);
  }
}

}  // namespace
}  // namespace vsslam

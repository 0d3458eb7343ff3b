#include "sensors/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/ordered_parallel.h"
#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

constexpr double kPi = std::numbers::pi;

/// Looks along world z from the origin of its own frame; `focal_px` sets how much it sees.
ViewRays pinhole(int width_px, int height_px, double focal_px) {
  ViewRays rays;
  rays.width_px = width_px;
  rays.height_px = height_px;
  rays.pixel_angle_rad = static_cast<float>(1 / focal_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      rays.direction_camera.push_back(
          Vec3((x - (width_px - 1) / 2.0) / focal_px, (y - (height_px - 1) / 2.0) / focal_px, 1)
              .normalized()
              .cast<float>());
  return rays;
}

/// The camera at `from` looks along world x; right in the picture is world -y.
SE3 looking_along_x(const Vec3& from) {
  return SE3::from_rpy({-kPi / 2, 0, -kPi / 2}, from);
}

/// A wall at x = 3 that faces the camera, without any other light than its own.
World wall_world(float reflectance) {
  World world;
  world.name = "wall";
  Material material = shapes::paint(0.5f);
  material.base_color = Vec3f::Constant(reflectance);
  world.materials = {material};
  shapes::add(world, shapes::wall({3, 0, 0}, -Vec3::UnitX(), 8), "wall", 0);
  return world;
}

Light point_light(const Vec3& position_world, double intensity_cd) {
  Light light{.name = "bulb", .group = "lamp"};
  light.position_world = position_world;
  light.intensity = intensity_cd;
  return light;
}

struct Scene {
  explicit Scene(World w, const LightingConfig& lighting = {})
      : world(std::move(w)), raycaster(world), renderer(world, raycaster, lighting) {}
  View render(const ViewRays& rays, const SE3& T_world_camera = looking_along_x(Vec3::Zero())) const {
    View view;
    renderer.render(T_world_camera, rays, view);
    return view;
  }
  World world;
  Raycaster raycaster;
  Renderer renderer;
};

TEST(Renderer, PlaneLitByOnePointFollowsLambert) {
  World world = wall_world(0.6f);
  world.lights = {point_light({1, 0.5, 0.25}, 700)};
  const Scene scene(std::move(world));
  const ViewRays rays = pinhole(64, 48, 40);
  const View view = scene.render(rays);
  for (size_t i = 0; i < view.luminance.size(); ++i) {
    const Vec3 d = rays.direction_camera[i].cast<double>();
    const Vec3 at(3, -3 * d.x() / d.z(), -3 * d.y() / d.z());
    const Vec3 to_light = Vec3(1, 0.5, 0.25) - at;
    const double lux = 700 * (2 / to_light.norm()) / to_light.squaredNorm();
    EXPECT_NEAR(view.luminance[i], 0.6 * lux / kPi, 0.01 * 0.6 * lux / kPi) << at.transpose();
    EXPECT_NEAR(view.depth_m[i], 3, 1e-5);
  }
}

TEST(Renderer, LightFallsWithTheSquareOfDistance) {
  for (const double distance_m : {1.0, 2.0, 4.0}) {
    World world = wall_world(0.5f);
    world.lights = {point_light({3 - distance_m, 0, 0}, 100)};
    const Scene scene(std::move(world));
    const double found = scene.render(pinhole(4, 4, 400)).luminance[5] * distance_m * distance_m;
    EXPECT_NEAR(found, 0.5 * 100 / kPi, 0.01 * found);
  }
}

TEST(Renderer, SameBytesForOneAndTwoThreads) {
  const ViewRays rays = pinhole(64, 48, 40);
  View views[2];
  for (int threads : {1, 2}) {
    set_thread_count(threads);
    World world = shapes::room_world({-2, -2, -1}, {4, 2, 2});
    world.lights = {point_light({1, 0.5, 0.25}, 700)};
    views[threads - 1] = Scene(std::move(world)).render(rays);
  }
  EXPECT_EQ(views[0].luminance, views[1].luminance);
  EXPECT_EQ(views[0].depth_m, views[1].depth_m);
}

}  // namespace
}  // namespace vsslam

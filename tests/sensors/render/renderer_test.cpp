#include "sensors/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ordered_parallel.h"
#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

constexpr double kPi = std::numbers::pi;

/// Looks along world z from the origin of its own frame; `focal_px` sets how much it sees.
ViewRays pinhole(int width_px, int height_px, double focal_px) {
  std::vector<Vec3f> directions;
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      directions.push_back(
          Vec3((x - (width_px - 1) / 2.0) / focal_px, (y - (height_px - 1) / 2.0) / focal_px, 1)
              .normalized()
              .cast<float>());
  return {width_px, height_px, std::move(directions), static_cast<float>(1 / focal_px)};
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

TEST(Renderer, ABoxCastsItsShadow) {
  World world = wall_world(0.6f);
  world.lights = {point_light({0, 0, 0}, 500)};
  Material black = shapes::paint(0.5f);
  black.base_color = Vec3f::Zero();
  world.materials.push_back(black);
  shapes::add(world, shapes::wall({2, 0, 0}, -Vec3::UnitX(), 0.8), "board", 1);  // shades 1.2 m of the wall
  const Scene scene(std::move(world));
  const ViewRays rays = pinhole(64, 64, 40);
  const View view = scene.render(rays, looking_along_x({2.5, 0, 0}));  // behind the board
  for (size_t i = 0; i < view.luminance.size(); ++i) {
    const Vec3f& d = rays.direction_camera[i];
    const float off_m = 0.5f * std::max(std::abs(d.x()), std::abs(d.y())) / d.z();
    ASSERT_LT(off_m, 0.45f);  // all in the shadow
    EXPECT_EQ(view.luminance[i], 0);
  }
  // From beside the board, well outside of the shadow.
  const double lux = 500 * (3 / Vec3(3, 2, 0).norm()) / 13;
  EXPECT_NEAR(scene.render(pinhole(4, 4, 400), looking_along_x({2.5, 2, 0})).luminance[5], 0.6 * lux / kPi,
              0.01 * lux);
}

TEST(Renderer, NoLightLeaksThroughAThinWall) {
  World world = shapes::room_world({-2, -2, -1}, {0, 2, 2});
  shapes::add(world, shapes::room({0.02, -2, -1}, {3, 2, 2}), "next room", 0);
  world.lights = {point_light({-1, 0, 0}, 1000)};
  const Scene scene(std::move(world));
  for (const double yaw : {0.0, 1.5, 3.0, 4.5}) {
    const SE3 turned = SE3::from_rpy({0, 0, yaw}, {1.5, 0, 0}) * looking_along_x(Vec3::Zero());
    for (const float l : scene.render(pinhole(32, 32, 16), turned).luminance) EXPECT_EQ(l, 0);
  }
}

// Emission L from everywhere, reflectance r: L (1 + r + r^2 + ...) in every direction.
TEST(Renderer, AFurnaceGlowsAsItsSeriesSays) {
  for (const float reflectance : {0.3f, 0.7f}) {
    World world = shapes::room_world({-3, -3, -1}, {3, 3, 2});
    world.materials[0].base_color = Vec3f::Constant(reflectance);
    world.materials[0].emissive = Vec3f::Constant(10);
    const Scene scene(std::move(world));
    for (const float l : scene.render(pinhole(32, 32, 16)).luminance)
      EXPECT_NEAR(l, 10 / (1 - reflectance), 0.01 * 10 / (1 - reflectance));
  }
}

/// A board at x = `distance_m` of squares that stand in the world's lattice, lit evenly by 1000 lux.
Scene chequered_board(double distance_m, float square_m, int texels_per_square) {
  World world = wall_world(1);
  const int side = 2 * texels_per_square;
  Texture texture{.name = "squares", .width_px = side, .height_px = side, .rgba = {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const bool white = (x < texels_per_square) == (y < texels_per_square);
      texture.rgba.insert(texture.rgba.end(), 3, white ? 255 : 0);
      texture.rgba.push_back(255);
    }
  world.textures = {texture};
  world.materials[0].base_color_texture = 0;
  Primitive& board = world.meshes[0].primitives[0];
  board = shapes::wall({distance_m, 0, 0}, -Vec3::UnitX(), 1.7 * distance_m);
  for (const Vec3f& p : board.positions) board.uvs.push_back(Vec2f(-p.y(), -p.z()) / (2 * square_m));
  world.lights = {
      {.name = "sun", .kind = Light::Kind::directional, .group = "sun", .direction_world = Vec3::UnitX()}};
  world.lights[0].intensity = 1000;
  LightingConfig lighting;
  lighting.sky_luminance_cdpm2 = 0;
  return Scene(std::move(world), lighting);
}

TEST(Renderer, EdgesLieWhereTheyAreProjected) {
  const Scene scene = chequered_board(3, 1, 30);  // not a power of two
  const double focal_px = 200;
  const SE3 T_world_camera = looking_along_x({0, 0.137, 0.5});
  const View view = scene.render(pinhole(320, 240, focal_px), T_world_camera);
  const double half = 0.5 * 1000 / kPi;
  int edges = 0;
  for (size_t x = 0; x + 1 < 320; ++x) {  // along the row through the middle of squares
    const float a = view.luminance[120 * 320 + x], b = view.luminance[120 * 320 + x + 1];
    if ((a < half) == (b < half)) continue;
    const double edge_px = static_cast<double>(x) + (half - a) / (b - a);
    const double y_m = 0.137 - 3 * (edge_px - 159.5) / focal_px;
    EXPECT_NEAR((y_m - std::round(y_m)) * focal_px / 3, 0, 0.02) << "px, at column " << x;
    ++edges;
  }
  EXPECT_EQ(edges, 5);
}

TEST(Renderer, DistantTextureIsItsMeanAndDoesNotShimmer) {
  const Scene scene = chequered_board(40, 0.1f, 30);  // squares of a fifth of a pixel
  for (const double shift_m : {0.0, 0.3, 0.77}) {
    const View view =
        scene.render(pinhole(64, 64, 80), looking_along_x({0, 0.1 * shift_m, 0.01 + 0.1 * shift_m}));
    for (const float l : view.luminance) EXPECT_NEAR(l, 500 / kPi, 0.02 * 500 / kPi);
  }
}

TEST(Renderer, GrazingTextureStaysSharpAcrossTheView) {
  World world = wall_world(1);
  Texture texture{.name = "stripes", .width_px = 64, .height_px = 1, .rgba = {}};
  for (int x = 0; x < 64; ++x) texture.rgba.insert(texture.rgba.end(), {255, 255, 255, 255});
  for (size_t i = 0; i < 4 * 32; ++i) texture.rgba[i] = 0;
  world.textures = {texture};
  world.materials[0].base_color_texture = 0;
  Primitive& floor = world.meshes[0].primitives[0];
  floor = shapes::quad({0, -10, -0.65}, {20, 0, 0}, {0, 20, 0});
  for (const Vec3f& p : floor.positions)
    floor.uvs.push_back(Vec2f(p.y() / 0.2f, 0));  // 0.1 m black, 0.1 m white
  world.lights = {{.name = "sun", .kind = Light::Kind::directional, .group = "sun"}};
  LightingConfig lighting;
  lighting.sky_luminance_cdpm2 = 0;
  const Scene scene(std::move(world), lighting);
  const View view = scene.render(pinhole(320, 240, 384));
  const size_t row = 120 + 42;  // 0.65 m * 384 px / 42 px = 5.9 m off: a pixel is 15 mm wide, 140 mm long
  const auto [low, high] =
      std::minmax_element(view.luminance.begin() + row * 320, view.luminance.begin() + (row + 1) * 320);
  EXPECT_GT((*high - *low) / (*high + *low), 0.8);
}

TEST(Renderer, PictureIsLinearInTheLevelsOfGroups) {
  World world = shapes::room_world({-2, -2, -1}, {4, 2, 2});
  world.lights = {point_light({1, 0.5, 0.25}, 700), point_light({-1, -1, 1}, 300)};
  world.lights[1].group = "other";
  Scene scene(std::move(world));
  ASSERT_EQ(scene.renderer.light_groups(), (std::vector<std::string>{"lamp", "other"}));
  const ViewRays rays = pinhole(32, 32, 16);
  const auto at = [&](float lamp, float other) {
    scene.renderer.set_light_levels({{lamp, other}});
    return scene.render(rays).luminance;
  };
  const std::vector<float> lamp = at(1, 0), other = at(0, 1), both = at(0.25f, 3), none = at(0, 0);
  for (size_t i = 0; i < both.size(); ++i) {
    EXPECT_NEAR(both[i], 0.25f * lamp[i] + 3 * other[i], 1e-4f * both[i]);
    EXPECT_EQ(none[i], 0);
  }
}

TEST(Renderer, HeadlightMovesWithTheCamera) {
  World world = wall_world(0.5f);
  world.lights = {point_light({0, 0, 0}, 1)};
  LightingConfig lighting;
  lighting.preset = LightingConfig::Preset::dark;
  const Scene scene(std::move(world), lighting);
  for (const double distance_m : {0.5, 1.0, 2.5}) {
    const double found =
        scene.render(pinhole(4, 4, 4000), looking_along_x({3 - distance_m, 0, 0})).luminance[5];
    const double lux = lighting.headlight_intensity_cd / (distance_m * distance_m);
    EXPECT_NEAR(found, 0.5 * lux / kPi, 1e-3 * lux);
  }
}

TEST(Renderer, AWorldWithoutLightStandsUnderAnOvercastSky) {
  const Scene open(wall_world(0.5f));
  const SE3 up = SE3::from_rpy({0, 0, 0}, Vec3::Zero());  // the camera's axis is the world's z
  const float zenith = open.render(pinhole(4, 4, 4000), up).luminance[5];
  EXPECT_NEAR(zenith, LightingConfig{}.sky_luminance_cdpm2, 1);
  EXPECT_TRUE(std::isinf(open.render(pinhole(4, 4, 4000), up).depth_m[5]));
  EXPECT_GT(open.render(pinhole(4, 4, 400)).luminance[5], 0.1 * zenith);
  const Scene closed(shapes::room_world({-4, -4, -1}, {4, 4, 5}));
  EXPECT_GT(closed.render(pinhole(4, 4, 400)).luminance[5], 0.05 * zenith);
}

TEST(Renderer, TheSkyGlowsAboutTheSun) {
  World world = wall_world(0.5f);
  const double lux = 20000, zenith = LightingConfig{}.sky_luminance_cdpm2;
  world.lights = {{.name = "sun",
                   .kind = Light::Kind::directional,
                   .group = "sun",
                   .direction_world = -Vec3::UnitZ(),
                   .intensity = lux}};
  Scene scene(std::move(world));
  const auto seen_at = [&](double from_zenith_rad) {
    const SE3 up = SE3::from_rpy({from_zenith_rad, 0, 0}, Vec3::Zero());  // at 0 the axis is the world's z
    return scene.render(pinhole(4, 4, 4000), up).luminance[5];
  };
  const double half_rad = 2 * std::asin(std::sqrt(0.04 * (std::sqrt(2.0) - 1)) / 2);
  EXPECT_NEAR(seen_at(0), zenith + 0.35 * lux, 20);
  EXPECT_NEAR(seen_at(half_rad), zenith * (1 + 2 * std::cos(half_rad)) / 3 + 0.5 * 0.35 * lux, 20);
  scene.renderer.set_light_levels({std::vector<float>(scene.renderer.light_groups().size(), 0.0f)});
  EXPECT_EQ(seen_at(0), 0);
}

TEST(Renderer, AMovedObjectKeepsItsLight) {
  World world = wall_world(0.5f);
  world.lights = {point_light({0, 0, 0}, 100)};
  Scene scene(std::move(world));
  const float before = scene.render(pinhole(4, 4, 400)).luminance[5];
  scene.raycaster.set_object_pose(0, Eigen::Affine3d(Eigen::Translation3d(1, 0, 0)), true);
  scene.raycaster.commit();
  const View after = scene.render(pinhole(4, 4, 400));
  EXPECT_NEAR(after.luminance[5], before, 0.01 * before);
  EXPECT_NEAR(after.depth_m[5], 4, 1e-5);
}

// An object that was moved to where it stood is traced ray by ray instead of in beams.
TEST(Renderer, BeamsShadeAsTheirRaysDo) {
  Scene scene = chequered_board(3, 0.1f, 30);
  const ViewRays rays = pinhole(68, 44, 30);  // not whole tiles
  const SE3 T_world_camera =
      looking_along_x({0.3, 0.137, 0.5}) * SE3::from_rpy({0.1, 0.5, 0.2}, Vec3::Zero());
  const View beams = scene.render(rays, T_world_camera);
  scene.raycaster.set_object_pose(0, Eigen::Affine3d::Identity(), true);
  scene.raycaster.commit();
  const View singly = scene.render(rays, T_world_camera);
  double sum = 0;
  for (size_t i = 0; i < beams.luminance.size(); ++i) {
    EXPECT_NEAR(1 / beams.depth_m[i], 1 / singly.depth_m[i], 1e-6);  // nothing is infinitely deep
    EXPECT_NEAR(beams.luminance[i], singly.luminance[i], 0.01 * 1000 / kPi);
    sum += std::abs(beams.luminance[i] - singly.luminance[i]);
  }
  EXPECT_LT(sum / static_cast<double>(beams.luminance.size()), 1e-4 * 1000 / kPi);
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

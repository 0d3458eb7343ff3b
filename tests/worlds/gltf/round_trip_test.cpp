#include <gtest/gtest.h>

#include <filesystem>

#include "core/files.h"
#include "core/se3.h"
#include "tests/scratch.h"
#include "tests/worlds/world_equality.h"
#include "worlds/gltf/gltf.h"
#include "worlds/indoor/corridor.h"
#include "worlds/indoor/room.h"

namespace vsslam {
namespace {

std::filesystem::path temporary(const std::string& name) {
  return scratch_folder() / name;
}

World there_and_back(const World& world, const std::string& name) {
  write_glb(world, temporary(name));
  return read_gltf(temporary(name));
}

TEST(GltfRoundTrip, CorridorIsTheSameToTheBit) {
  CorridorConfig config;
  config.textures = false;
  config.jamb_depth_m = 0.15;
  config.floor_unevenness_m = 0.004;
  const World world = make_corridor(config);
  expect_same(world, there_and_back(world, "corridor.glb"));
}

TEST(GltfRoundTrip, TexturesAreTheSameToTheBit) {
  const World world = make_room({});
  expect_same(world, there_and_back(world, "room.glb"));
}

TEST(GltfRoundTrip, PlacementsLightsAndMaterials) {
  RoomConfig config;
  config.textures = false;
  World world = make_room(config);
  world.name = "odd \"name\"";
  world.floor = {
      .height_m = -0.25, .unevenness_m = 1.0 / 3, .wavelength_m = 0.7, .seed = 0xFFFFFFFFFFFFFFFFull};
  world.objects[3].T_world_object =
      Eigen::Translation3d(1.0 / 3, -2.7, 0.1) * SE3::from_rpy({0.3, -0.7, 2.1}, Vec3::Zero()).rotation;
  world.objects[4].T_world_object = Eigen::Translation3d(1, 2, 3) * Eigen::Scaling(2.0, 0.5, 1.1);
  Light spot{.name = "spot", .kind = Light::Kind::spot, .group = "emergency"};
  spot.direction_world = Vec3(0.3, -0.4, -0.8).normalized();
  spot.position_world = {0.1, 0.2, 2.9};
  spot.inner_cone_rad = 0.1;
  spot.outer_cone_rad = 0.6;
  spot.range_m = 7.7;
  world.lights.push_back(spot);
  world.lights.push_back(
      {.name = "sun", .kind = Light::Kind::directional, .group = "sun", .direction_world = {0, 0.6, -0.8}});
  for (Light& light : world.lights)
    if (light.kind != Light::Kind::spot) light.inner_cone_rad = 0;
  world.materials[0].emissive = {3.3f, 0.1f, 1.0f / 3};
  world.materials[1].metallic = 0.37f;
  world.materials[1].roughness = 1.0f;
  world.textures.push_back({"tiny", 2, 1, {1, 2, 3, 255, 250, 128, 7, 9}});
  world.materials[1].base_color_texture = 0;
  world.materials[1].base_color_transform = {{0.1f, -0.2f}, {3.0f, 1.0f / 7}, 0.4f};
  expect_same(world, there_and_back(world, "odd.glb"));
}

TEST(GltfRoundTrip, NothingButOneTriangle) {
  World world;
  world.name = "bare";
  world.materials.push_back({.name = ""});
  world.meshes.push_back({.name = "", .primitives = {{}}});
  Primitive& p = world.meshes[0].primitives[0];
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals.assign(3, Vec3f::UnitZ());
  p.triangles = {{0, 1, 2}};
  world.objects.push_back({.name = "only"});
  expect_same(world, there_and_back(world, "bare.glb"));
  world.routes.emplace_back().name = "nowhere";
  expect_same(world, there_and_back(world, "bare.glb"));
}

TEST(GltfRoundTrip, WritesTheSameBytesTwice) {
  RoomConfig config;
  config.textures = false;
  write_glb(make_room(config), temporary("one.glb"));
  write_glb(make_room(config), temporary("two.glb"));
  EXPECT_EQ(read_file(temporary("one.glb")), read_file(temporary("two.glb")));
}

}  // namespace
}  // namespace vsslam

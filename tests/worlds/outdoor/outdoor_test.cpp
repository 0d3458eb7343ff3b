#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "core/rng.h"
#include "tests/scratch.h"
#include "tests/worlds/geometry.h"
#include "tests/worlds/world_equality.h"
#include "worlds/describe.h"
#include "worlds/factory/world_source.h"
#include "worlds/gltf/gltf.h"
#include "worlds/outdoor/gate.h"
#include "worlds/outdoor/street.h"
#include "worlds/outdoor/tree.h"
#include "worlds/route.h"

namespace vsslam {
namespace {

GateConfig plain_gate() {
  GateConfig config;
  config.textures = false;
  return config;
}
StreetConfig plain_street() {
  StreetConfig config;
  config.textures = false;
  return config;
}
std::vector<World> plain_worlds() {
  return {make_gate(plain_gate()), make_street(plain_street())};
}

TEST(Outdoor, TrianglesAreFiniteAndTheirNormalsPointOutwards) {
  for (const World& world : plain_worlds()) {
    size_t slivers = 0;
    for (const Mesh& mesh : world.meshes)
      for (const Primitive& p : mesh.primitives) {
        ASSERT_EQ(p.positions.size(), p.normals.size());
        for (const Vec3f& v : p.positions) ASSERT_TRUE(v.allFinite()) << mesh.name;
        for (const Vec3f& n : p.normals) ASSERT_NEAR(n.norm(), 1, 1e-5) << mesh.name;
        for (const auto& t : p.triangles) {
          const Vec3f a = p.positions[t[0]], cross = (p.positions[t[1]] - a).cross(p.positions[t[2]] - a);
          slivers += cross.norm() < 1e-7f;
          ASSERT_GE(cross.dot(p.normals[t[0]] + p.normals[t[1]] + p.normals[t[2]]), 0)
              << mesh.name << ", " << world.materials[static_cast<size_t>(p.material)].name << " at "
              << a.transpose();
        }
      }
    EXPECT_LT(slivers, world.triangle_count() / 1000);
  }
}

TEST(Outdoor, SizesAreThoseOfTheSequences) {
  const std::vector<World> worlds = plain_worlds();
  for (const World& world : worlds) {
    EXPECT_GT(world.triangle_count(), 80'000u) << world.name;
    EXPECT_LT(world.triangle_count(), 700'000u) << world.name;
  }
  const auto length_m = [&](size_t world, const std::string& name) {
    for (const Route& route : worlds[world].routes)
      if (route.name == name) return route_length_m(route);
    return 0.0;
  };
  // A right angle rounded with radius 4 saves (2 - pi / 2) 4.
  const double saved_m = (2 - std::numbers::pi / 2) * 4;
  EXPECT_NEAR(length_m(0, "around"), 2 * (58 + 42) - 4 * saved_m, 0.1);
  EXPECT_NEAR(length_m(1, "avenue"), 4 * 80 - 2 * 17, 1e-6);
  EXPECT_NEAR(length_m(1, "lawn"), 1280 - 8 * saved_m, 0.2);
  EXPECT_NEAR(length_m(1, "zigzag"), 560 - 6 * saved_m, 0.2);
}

// What may touch a robot on any route: a lane's width aside and its own half width.
TEST(Outdoor, RoutesAreFree) {
  for (const World& world : plain_worlds()) {
    std::vector<WorldTriangle> low;
    for (const WorldTriangle& t : triangles_of(world)) {
      double bottom = 1e9, top = -1e9;
      for (const Vec3& c : t.corners_world) bottom = std::min(bottom, c.z()), top = std::max(top, c.z());
      if (bottom < 1.6 && top > 0.02) low.push_back(t);
    }
    for (const Route& route : world.routes)
      for (size_t i = 0; i < route.points_world.size(); i += 25)
        EXPECT_GE(clearance_m(low, route.points_world[i], 0.02, 1.6), 1.9)
            << world.name << " " << route.name << " at " << route.points_world[i].transpose();
  }
}

TEST(Outdoor, RaysPartlyPassThroughFoliageAndFences) {
  const OutdoorPalette palette = make_outdoor_palette(1, false);
  const auto share_blocked = [](const Mesh& mesh, const Vec3& middle, double half_y_m, double half_z_m) {
    World world;
    world.meshes = {mesh};
    world.objects = {{.name = "it", .mesh = 0}};
    const auto triangles = triangles_of(world);
    const RandomStream stream(1, "rays");
    int blocked = 0, rays = 0;
    for (uint64_t i = 0; i < 400; ++i) {
      const double y = 2 * stream.uniform(i, 0) - 1, z = 2 * stream.uniform(i, 1) - 1;
      if (y * y + z * z > 1) continue;
      ++rays;
      blocked +=
          cast_ray(triangles, middle + Vec3(-10, half_y_m * y, half_z_m * z), Vec3::UnitX()).has_value();
    }
    return static_cast<double>(blocked) / rays;
  };
  for (const int clusters : {500, 900}) {
    Tree tree;
    tree.leaf_clusters = clusters;
    tree.cluster_m = 0.3 * std::sqrt(1000.0 / clusters);
    const double share =
        share_blocked(make_foliage(palette, tree), {0, 0, tree.height_m - 1.2 * tree.crown_radius_m},
                      tree.crown_radius_m, 1.2 * tree.crown_radius_m);
    EXPECT_GT(share, 0.2);
    EXPECT_LT(share, 0.9);
  }
}

TEST(Outdoor, LampsShineWhereTheirPanelsAreAndTheSunStandsHigh) {
  for (const World& world : plain_worlds()) {
    std::set<std::string> groups;
    for (const Light& light : world.lights) groups.insert(light.group);
    EXPECT_EQ(groups, (std::set<std::string>{"lamp", "sun"}));
    int panel = -1;
    for (size_t m = 0; m < world.materials.size(); ++m)
      if (world.materials[m].name == "lamp") panel = static_cast<int>(m);
    std::vector<Vec3> panels;
    for (const WorldTriangle& t : triangles_of(world))
      if (t.material == panel)
        panels.push_back((t.corners_world[0] + t.corners_world[1] + t.corners_world[2]) / 3);
    for (const Light& light : world.lights) {
      if (light.kind == Light::Kind::directional) {
        EXPECT_LT(light.direction_world.z(), -0.4);
        continue;
      }
      const bool near = std::any_of(panels.begin(), panels.end(),
                                    [&](const Vec3& p) { return (p - light.position_world).norm() < 0.3; });
      EXPECT_TRUE(near) << light.name;
    }
  }
}

TEST(Outdoor, SameSeedSameWorldOtherSeedAnother) {
  GateConfig gate = plain_gate();
  StreetConfig street = plain_street();
  expect_same(make_gate(gate), make_gate(gate));
  expect_same(make_street(street), make_street(street));
  const std::string gate_1 = describe(make_gate(gate)), street_1 = describe(make_street(street));
  gate.seed = street.seed = 2;
  EXPECT_NE(describe(make_gate(gate)), gate_1);
  EXPECT_NE(describe(make_street(street)), street_1);
}

TEST(Outdoor, AGateSurvivesGltf) {
  const World world = make_gate(plain_gate());
  const std::filesystem::path file = scratch_folder() / "gate.glb";
  write_glb(world, file);
  const World back = read_gltf(file);
  EXPECT_EQ(back.triangle_count(), world.triangle_count());
  EXPECT_EQ(back.meshes.size(), world.meshes.size());
  EXPECT_EQ(back.objects.size(), world.objects.size());
  EXPECT_EQ(back.lights.size(), world.lights.size());
  EXPECT_EQ(back.routes.size(), world.routes.size());
  // Shared meshes are stored once: far fewer triangles than the world shows.
  size_t stored = 0;
  for (const Mesh& mesh : world.meshes)
    for (const Primitive& p : mesh.primitives) stored += p.triangles.size();
  EXPECT_LT(stored, world.triangle_count() / 2);
  EXPECT_LT(std::filesystem::file_size(file), 110 * stored + 1'000'000);
}

TEST(Outdoor, AMillionTrianglesAreNoTrouble) {
  StreetConfig config = plain_street();
  config.columns = 10;
  config.rows = 7;
  EXPECT_GT(make_street(config).triangle_count(), 1'000'000u);
}

}  // namespace
}  // namespace vsslam

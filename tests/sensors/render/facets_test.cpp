#include "sensors/render/facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

struct Drawn {
  explicit Drawn(const World& world)
      : triangles(world),
        textures(world),
        charts(chart_surfaces(triangles, 0.15, 10'000)),
        records(surface_records(triangles, charts, textures)),
        facet_of(facets(triangles, records)) {}
  size_t count() const { return std::set<uint32_t>(facet_of.begin(), facet_of.end()).size(); }

  PlacedTriangles triangles;
  GreyTextures textures;
  LightMapCharts charts;
  std::vector<SurfaceRecord> records;
  std::vector<uint32_t> facet_of;
};

/// Six squares of 1 m in a row along x, with a texture of 2 m, their texture coordinates `shift`ed one by one.
World strip(float shift, double bend_rad = 0) {
  World world;
  world.textures = {
      {.name = "grey", .width_px = 64, .height_px = 64, .rgba = std::vector<uint8_t>(4 * 64 * 64, 99)}};
  world.materials = {shapes::paint(0.5f)};
  world.materials[0].base_color_texture = 0;
  Primitive all;
  Vec3 from(0, 0, 0);
  for (int i = 0; i < 6; ++i) {
    const Vec3 along(std::cos(i * bend_rad), 0, std::sin(i * bend_rad));
    const Primitive square = shapes::quad(from, along, {0, 1, 0});
    const auto first = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), square.positions.begin(), square.positions.end());
    all.normals.insert(all.normals.end(), square.normals.begin(), square.normals.end());
    for (const Vec2f& corner : {Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1)})
      all.uvs.push_back(0.5f * (corner + Vec2f(static_cast<float>(i), 0)) +
                        Vec2f(shift * static_cast<float>(i), 0));
    for (const auto& t : square.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    from += along;
  }
  shapes::add(world, std::move(all), "strip", 0);
  return world;
}

TEST(Facets, AFlatStripIsOne) {
  const Drawn strip_drawn(strip(0));
  EXPECT_EQ(strip_drawn.count(), 1u);
}

TEST(Facets, WholeTurnsOfTheTextureMakeNoDifference) {
  EXPECT_EQ(Drawn(strip(3)).count(), 1u);
}

TEST(Facets, OtherTextureOtherFacet) {
  EXPECT_EQ(Drawn(strip(0.1f)).count(), 6u);
}

TEST(Facets, EachPlaneIsItsOwn) {
  EXPECT_EQ(Drawn(strip(0, 0.02)).count(), 6u);
}

TEST(Facets, ObjectsAndMaterialsStayApart) {
  World world = strip(0);
  world.objects.push_back(world.objects[0]);
  EXPECT_EQ(Drawn(world).count(), 2u);
  world = strip(0);
  world.materials.push_back(world.materials[0]);
  Primitive second = world.meshes[0].primitives[0];
  second.material = 1;
  world.meshes[0].primitives[0].triangles.resize(6);
  second.triangles.erase(second.triangles.begin(), second.triangles.begin() + 6);
  world.meshes[0].primitives.push_back(second);
  EXPECT_EQ(Drawn(world).count(), 2u);
}

}  // namespace
}  // namespace vsslam

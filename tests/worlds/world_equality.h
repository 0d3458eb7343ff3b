// Exact comparison of worlds.
#pragma once

#include <gtest/gtest.h>

#include "worlds/world.h"

namespace vsslam {

inline void expect_same(const Primitive& a, const Primitive& b) {
  EXPECT_EQ(a.material, b.material);
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.normals == b.normals);
  EXPECT_TRUE(a.uvs == b.uvs);
  EXPECT_TRUE(a.triangles == b.triangles);
}

inline void expect_same(const Material& a, const Material& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.base_color, b.base_color);
  EXPECT_EQ(a.base_color_texture, b.base_color_texture);
  EXPECT_EQ(a.base_color_transform.offset, b.base_color_transform.offset);
  EXPECT_EQ(a.base_color_transform.scale, b.base_color_transform.scale);
  EXPECT_EQ(a.base_color_transform.rotation_rad, b.base_color_transform.rotation_rad);
  EXPECT_EQ(a.emissive, b.emissive);
  EXPECT_EQ(a.roughness, b.roughness);
  EXPECT_EQ(a.metallic, b.metallic);
  EXPECT_EQ(a.lidar_albedo, b.lidar_albedo);
  EXPECT_EQ(a.retro_reflective, b.retro_reflective);
  EXPECT_EQ(a.glass, b.glass);
}

inline void expect_same(const Light& a, const Light& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.group, b.group);
  EXPECT_EQ(a.position_world, b.position_world);
  EXPECT_EQ(a.direction_world, b.direction_world);
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.range_m, b.range_m);
  EXPECT_EQ(a.radius_m, b.radius_m);
  EXPECT_EQ(a.inner_cone_rad, b.inner_cone_rad);
  EXPECT_EQ(a.outer_cone_rad, b.outer_cone_rad);
}

inline void expect_same(const World& a, const World& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (size_t i = 0; i < a.textures.size(); ++i) {
    EXPECT_EQ(a.textures[i].name, b.textures[i].name);
    EXPECT_EQ(a.textures[i].width_px, b.textures[i].width_px);
    EXPECT_EQ(a.textures[i].height_px, b.textures[i].height_px);
    EXPECT_TRUE(a.textures[i].rgba == b.textures[i].rgba);
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (size_t i = 0; i < a.materials.size(); ++i) expect_same(a.materials[i], b.materials[i]);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_EQ(a.meshes[i].name, b.meshes[i].name);
    ASSERT_EQ(a.meshes[i].primitives.size(), b.meshes[i].primitives.size());
    for (size_t k = 0; k < a.meshes[i].primitives.size(); ++k)
      expect_same(a.meshes[i].primitives[k], b.meshes[i].primitives[k]);
  }
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].name, b.objects[i].name);
    EXPECT_EQ(a.objects[i].mesh, b.objects[i].mesh);
    EXPECT_EQ(a.objects[i].collision, b.objects[i].collision);
    EXPECT_EQ(a.objects[i].T_world_object.matrix(), b.objects[i].T_world_object.matrix());
  }
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (size_t i = 0; i < a.lights.size(); ++i) expect_same(a.lights[i], b.lights[i]);
  ASSERT_EQ(a.routes.size(), b.routes.size());
  for (size_t i = 0; i < a.routes.size(); ++i) {
    EXPECT_EQ(a.routes[i].name, b.routes[i].name);
    EXPECT_EQ(a.routes[i].closed, b.routes[i].closed);
    EXPECT_TRUE(a.routes[i].points_world == b.routes[i].points_world);
  }
  EXPECT_EQ(a.floor.height_m, b.floor.height_m);
  EXPECT_EQ(a.floor.unevenness_m, b.floor.unevenness_m);
  EXPECT_EQ(a.floor.wavelength_m, b.floor.wavelength_m);
  EXPECT_EQ(a.floor.seed, b.floor.seed);
}

}  // namespace vsslam

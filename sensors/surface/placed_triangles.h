// The world's triangles one after another, as the renderer prepares them: in the world frame, with texture
// coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "worlds/world.h"

namespace vsslam {

struct PlacedTriangle {
  std::array<Vec3f, 3> corners_world;
  std::array<Vec2f, 3> uv;  ///< of the base colour's texture, its transform included; whole turns removed
  Vec3f normal_world;       ///< geometric, unit, on the side of the vertices' normals; zero if degenerate
  uint32_t object = 0;
  int material = 0;
  float area_m2 = 0;
};

struct PlacedTriangles {
  explicit PlacedTriangles(const World& world);
  size_t index(uint32_t object, uint32_t triangle) const { return first_of_object[object] + triangle; }

  std::vector<PlacedTriangle> all;      ///< objects in order, primitives in order
  std::vector<size_t> first_of_object;  ///< and the total at the end
};

}  // namespace vsslam

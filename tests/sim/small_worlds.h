// Worlds of a few boxes, for tests.
#pragma once

#include <string>

#include "worlds/world.h"

namespace vsslam {

/// An endless plane floor.
inline World plane_world() {
  World world;
  world.name = "plane";
  return world;
}

/// Adds an axis-aligned box with its corners at low and high; returns the object's index.
inline int add_box(World& world, const std::string& name, const Vec3f& low, const Vec3f& high) {
  Primitive box;
  for (int i = 0; i < 8; ++i)
    box.positions.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                               i & 4 ? high.z() : low.z());
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  box.normals.assign(8, Vec3f::UnitZ());
  if (world.materials.empty()) world.materials.emplace_back();
  world.meshes.push_back({name, {box}});
  world.objects.push_back({.name = name, .mesh = static_cast<int>(world.meshes.size()) - 1});
  return static_cast<int>(world.objects.size()) - 1;
}

/// A plane with one closed route, a rectangle of 2 a x 2 b about the origin, counterclockwise from (a, -b), and one
/// open route, "line", from (0, 0) to (10, 0).
inline World routes_world(double a, double b) {
  World world = plane_world();
  world.routes.push_back({"ring", true, {{a, -b, 0}, {a, b, 0}, {-a, b, 0}, {-a, -b, 0}}});
  world.routes.push_back({"line", false, {{0, 0, 0}, {10, 0, 0}}});
  return world;
}

}  // namespace vsslam

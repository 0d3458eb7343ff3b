// Geometry of worlds by brute force, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "worlds/world.h"

namespace vsslam {

struct WorldTriangle {
  std::array<Vec3, 3> corners_world;
  int object = 0, material = 0;
  Vec3 normal() const {
    return (corners_world[1] - corners_world[0]).cross(corners_world[2] - corners_world[0]).normalized();
  }
};

inline std::vector<WorldTriangle> triangles_of(const World& world) {
  std::vector<WorldTriangle> triangles;
  for (size_t o = 0; o < world.objects.size(); ++o)
    for (const Primitive& p : world.meshes[static_cast<size_t>(world.objects[o].mesh)].primitives)
      for (const auto& t : p.triangles) {
        WorldTriangle w{{}, static_cast<int>(o), p.material};
        for (size_t k = 0; k < 3; ++k)
          w.corners_world[k] = world.objects[o].T_world_object * p.positions[t[k]].cast<double>();
        triangles.push_back(w);
      }
  return triangles;
}

struct RayHit {
  double range_m;
  size_t triangle;
};
/// Moller and Trumbore, either side.
inline std::optional<RayHit> cast_ray(const std::vector<WorldTriangle>& triangles, const Vec3& origin,
                                      const Vec3& direction) {
  std::optional<RayHit> nearest;
  for (size_t i = 0; i < triangles.size(); ++i) {
    const auto& c = triangles[i].corners_world;
    const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], p = direction.cross(e2);
    const double det = e1.dot(p);
    if (std::abs(det) < 1e-14) continue;
    const Vec3 s = origin - c[0], q = s.cross(e1);
    const double u = s.dot(p) / det, v = direction.dot(q) / det, t = e2.dot(q) / det;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9 || t < 1e-9) continue;
    if (!nearest || t < nearest->range_m) nearest = RayHit{t, i};
  }
  return nearest;
}

/// Edges whose neighbour does not run the other way: none on a closed surface.
inline size_t open_edges(const std::vector<WorldTriangle>& triangles) {
  using Point = std::array<double, 3>;
  std::map<std::pair<Point, Point>, int> balance;
  const auto key = [](const Vec3& v) { return Point{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}; };
  for (const WorldTriangle& t : triangles)
    for (size_t k = 0; k < 3; ++k) {
      const Point a = key(t.corners_world[k]), b = key(t.corners_world[(k + 1) % 3]);
      if (a < b)
        ++balance[{a, b}];
      else
        --balance[{b, a}];
    }
  return static_cast<size_t>(
      std::count_if(balance.begin(), balance.end(), [](const auto& e) { return e.second != 0; }));
}

/// Horizontal distance from a point to the nearest triangle edge that lies between the two heights.
inline double clearance_m(const std::vector<WorldTriangle>& triangles, const Vec3& point, double low_m,
                          double high_m) {
  double nearest = 1e9;
  for (const WorldTriangle& t : triangles) {
    double bottom = 1e9, top = -1e9;
    for (const Vec3& c : t.corners_world) bottom = std::min(bottom, c.z()), top = std::max(top, c.z());
    if (top < low_m || bottom > high_m) continue;
    for (size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d a = t.corners_world[k].head<2>(), d = t.corners_world[(k + 1) % 3].head<2>() - a,
                            p = point.head<2>() - a;
      const double along = d.squaredNorm() > 0 ? std::clamp(p.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, (p - along * d).norm());
    }
  }
  return nearest;
}

}  // namespace vsslam

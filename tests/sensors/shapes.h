// Worlds of a few triangles, and simple motions, for tests with closed-form answers.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "sensors/measurement/samples.h"
#include "sim/trajectory.h"
#include "worlds/world.h"

namespace vsslam::shapes {

inline Material paint(float albedo) {
  Material material;
  material.name = "paint";
  material.lidar_albedo = albedo;
  return material;
}

/// Adds an object of one primitive at the identity; returns its index.
inline int add(World& world, Primitive primitive, const std::string& name, int material) {
  primitive.material = material;
  world.meshes.push_back({name, {std::move(primitive)}});
  Object object;
  object.name = name;
  object.mesh = static_cast<int>(world.meshes.size()) - 1;
  world.objects.push_back(object);
  return static_cast<int>(world.objects.size()) - 1;
}

/// The parallelogram corner + a u + b v, 0 <= a, b <= 1, normal u x v.
inline Primitive quad(const Vec3& corner, const Vec3& u, const Vec3& v) {
  Primitive p;
  const Vec3 corners[4] = {corner, corner + u, corner + u + v, corner + v};
  const Vec3 normal = u.cross(v).normalized();
  for (const Vec3& c : corners) {
    p.positions.push_back(c.cast<float>());
    p.normals.push_back(normal.cast<float>());
  }
  p.triangles = {{0, 1, 2}, {0, 2, 3}};
  return p;
}

/// A wall through `point` that faces `normal`, `size_m` wide and high.
inline Primitive wall(const Vec3& point, const Vec3& normal, double size_m) {
  const Vec3 n = normal.normalized();
  const Vec3 u = (std::abs(n.z()) < 0.9 ? Vec3::UnitZ().cross(n) : Vec3::UnitX().cross(n)).normalized();
  const Vec3 v = n.cross(u);
  return quad(point - size_m / 2 * (u + v), size_m * u, size_m * v);
}

/// Six faces seen from inside.
inline Primitive room(const Vec3& low, const Vec3& high) {
  Primitive all;
  const Vec3 size = high - low;
  const Vec3 x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  for (const Primitive& face : {quad(low, y, z), quad(low, z, x), quad(low, x, y), quad(high, -z, -y),
                                quad(high, -x, -z), quad(high, -y, -x)}) {
    const auto first = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), face.positions.begin(), face.positions.end());
    all.normals.insert(all.normals.end(), face.normals.begin(), face.normals.end());
    for (const auto& t : face.triangles) all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

inline World room_world(const Vec3& low, const Vec3& high, float albedo = 0.5f) {
  World world;
  world.name = "room";
  world.materials = {paint(albedo)};
  add(world, room(low, high), "room", 0);
  return world;
}

/// A trajectory through T_world_base(t), from 0 to `duration_s`.
inline Trajectory along(const std::function<SE3(double)>& T_world_base, double duration_s,
                        Duration knot_interval = Duration{10'000'000}) {
  Trajectory trajectory(knot_interval);
  for (int64_t ns = -2 * knot_interval.ns;
       ns <= static_cast<int64_t>(duration_s * 1e9) + 3 * knot_interval.ns; ns += knot_interval.ns)
    trajectory.push(Time{ns}, T_world_base(static_cast<double>(ns) * 1e-9));
  return trajectory;
}

inline Trajectory at_rest(const SE3& T_world_base, double duration_s) {
  return along([&](double) { return T_world_base; }, duration_s);
}

/// Driving and turning as a robot does, with some roll, pitch and heave.
inline SE3 lively(double t) {
  return SE3::from_rpy({0.02 * std::sin(7 * t), 0.03 * std::sin(5 * t + 1), 0.6 * std::sin(0.9 * t)},
                       {1.5 * std::sin(0.4 * t), 0.8 * std::cos(0.5 * t), 0.02 * std::sin(6 * t)});
}

}  // namespace vsslam::shapes

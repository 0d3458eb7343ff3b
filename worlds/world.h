// What exists: triangle meshes, materials, lights and names. Frame `world`: z up, metres.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/se3.h"

namespace vsslam {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;

/// 8-bit sRGB with alpha, row-major, top row first.
struct Texture {
  std::string name;
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> rgba;  ///< 4 * width * height bytes
};

/// KHR_texture_transform: uv' = offset + R(rotation) * (scale * uv).
struct TextureTransform {
  Vec2f offset = Vec2f::Zero();
  Vec2f scale = Vec2f::Ones();
  float rotation_rad = 0;
};

struct Material {
  std::string name;
  // For the camera (linear RGB).
  Vec3f base_color = Vec3f::Constant(0.8f);
  int base_color_texture = -1;  ///< index into World::textures, -1: none
  TextureTransform base_color_transform{};
  Vec3f emissive = Vec3f::Zero();
  float roughness = 0.9f;
  float metallic = 0.0f;
  // For the LiDAR, at 905 nm.
  float lidar_albedo = 0.5f;      ///< diffuse reflectance, 0..1
  bool retro_reflective = false;  ///< reflectivity bytes above 100
  bool glass = false;             ///< most energy passes through; little or nothing returns
};

/// Triangles of one material, counter-clockwise seen from outside. Coordinates are the object's.
struct Primitive {
  int material = 0;  ///< index into World::materials
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  ///< one per position, unit length
  std::vector<Vec2f> uvs;      ///< one per position, or empty
  std::vector<std::array<uint32_t, 3>> triangles;
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
};

/// How the simulation collides with an object.
enum class Collision { mesh, none };

/// A mesh placed in the world. Several objects may share a mesh.
struct Object {
  std::string name;
  int mesh = 0;
  Eigen::Affine3d T_world_object = Eigen::Affine3d::Identity();
  Collision collision = Collision::mesh;
};

/// KHR_lights_punctual, in the world frame.
struct Light {
  enum class Kind { directional, point, spot };
  std::string name;
  Kind kind = Kind::point;
  std::string group;  ///< switched together by events and presets: "lamp", "emergency", ...
  Vec3 position_world = Vec3::Zero();
  Vec3 direction_world = -Vec3::UnitZ();
  Vec3f color = Vec3f::Ones();  ///< linear RGB
  double intensity = 1.0;       ///< cd (point, spot) or lux (directional)
  double range_m = 0;           ///< 0: unlimited
  double radius_m = 0;          ///< of the shining disc across direction_world, for soft shadows; 0: a point
  double inner_cone_rad = 0, outer_cone_rad = 0.7853981633974483;
};

/// The ground that the wheels stand on: a plane, or a smooth sum of waves. Analytic, because driving on
/// triangles shakes the IMU; the visual floor mesh (collision none) follows it.
struct Floor {
  double height_m = 0;
  double unevenness_m = 0;    ///< RMS height of the waves; 0: a plane
  double wavelength_m = 2.0;  ///< of the shortest wave
  uint64_t seed = 1;

  double height(double x_m, double y_m) const;
  Vec3 normal(double x_m, double y_m) const;
};

/// A named path that a scenario may follow.
struct Route {
  std::string name;
  bool closed = false;  ///< the last point connects to the first
  std::vector<Vec3> points_world;
};

struct World {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Object> objects;
  std::vector<Light> lights;
  std::vector<Route> routes;
  Floor floor;

  size_t triangle_count() const;  ///< of all objects (a shared mesh counts once per object)
};

}  // namespace vsslam

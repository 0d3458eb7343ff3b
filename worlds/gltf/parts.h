// From the parts of a glTF file to the parts of a World. glTF is y-up; a World is z-up.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "worlds/gltf/accessor.h"
#include "worlds/gltf/content.h"
#include "worlds/world.h"

namespace vsslam {

/// (x, y, z) of glTF is (x, -z, y) of a World, and back.
inline Vec3f z_up(const Vec3f& v) {
  return {v.x(), -v.z(), v.y()};
}
inline Vec3f y_up(const Vec3f& v) {
  return {v.x(), v.z(), -v.y()};
}
inline Vec3 z_up(const Vec3& v) {
  return {v.x(), -v.z(), v.y()};
}
inline Vec3 y_up(const Vec3& v) {
  return {v.x(), v.z(), -v.y()};
}

inline Mat3 rotation_to_z_up() {
  return (Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
}
/// A transform between frames that are y-up as one between the same frames z-up, and back. Numbers only move
/// and change signs, so nothing is rounded.
inline Eigen::Affine3d z_up(const Eigen::Affine3d& T) {
  const Mat3 C = rotation_to_z_up();
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = C * T.linear() * C.transpose();
  result.translation() = C * T.translation();
  return result;
}
inline Eigen::Affine3d y_up(const Eigen::Affine3d& T) {
  const Mat3 C = rotation_to_z_up();
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = C.transpose() * T.linear() * C;
  result.translation() = C.transpose() * T.translation();
  return result;
}

// What glTF has no place for travels in `extras`, under this key:
//   material: lidar_albedo, retro_reflective, glass
//   node:     collision ("mesh" or "none"); light_group on a node with a light
//   scene:    floor {height_m, unevenness_m, wavelength_m, seed (text)}, routes [{name, closed,
//   points_world}]
inline constexpr const char* kGltfExtras = "vsslam";

/// Images that are some material's base colour.
std::set<size_t> base_color_images(const nlohmann::json& json);

/// Materials and, as textures, the images that they use. A default material is added if a primitive has none;
/// `texture_images` gets the image of each texture.
void read_materials(const GltfBytes& in, std::vector<Texture> images, World& world);

/// The `texCoord` set of a material's base colour.
int base_color_texcoord(const nlohmann::json& json, size_t material);

/// Every mesh; primitives that are not triangles are left out. `default_material` stands where none is named.
std::vector<Mesh> read_meshes(const GltfBytes& in, int default_material);

/// Light `index` of KHR_lights_punctual, without its place.
Light read_light(const GltfBytes& in, size_t index);

/// Objects and lights from the nodes of the scene; floor and routes from its extras.
void read_scene(const GltfBytes& in, World& world);

}  // namespace vsslam

#include "sensors/surface/placed_triangles.h"

#include <cmath>

namespace vsslam {

namespace {

// v counts down, so that a counter-clockwise turn of the coordinates takes u towards -v.
Vec2f transformed(const TextureTransform& t, const Vec2f& uv) {
  const float c = std::cos(t.rotation_rad), s = std::sin(t.rotation_rad);
  const Vec2f scaled = t.scale.cwiseProduct(uv);
  return t.offset + Vec2f(c * scaled.x() + s * scaled.y(), -s * scaled.x() + c * scaled.y());
}

PlacedTriangle placed(const Primitive& primitive, const std::array<uint32_t, 3>& corners,
                      const Eigen::Affine3d& T_world_object, const TextureTransform& transform) {
  PlacedTriangle t;
  Vec3 vertex_normal = Vec3::Zero();
  for (size_t k = 0; k < 3; ++k) {
    t.corners_world[k] = (T_world_object * primitive.positions[corners[k]].cast<double>()).cast<float>();
    t.uv[k] =
        primitive.uvs.empty() ? Vec2f(Vec2f::Zero()) : transformed(transform, primitive.uvs[corners[k]]);
    if (!primitive.normals.empty()) vertex_normal += primitive.normals[corners[k]].cast<double>();
  }
  const Vec2f turns(std::floor(t.uv[0].x()), std::floor(t.uv[0].y()));
  for (Vec2f& uv : t.uv) uv -= turns;
  const Vec3 a = t.corners_world[0].cast<double>();
  const Vec3 cross = (t.corners_world[1].cast<double>() - a).cross(t.corners_world[2].cast<double>() - a);
  const double twice_area = cross.norm();
  t.area_m2 = static_cast<float>(0.5 * twice_area);
  t.normal_world = Vec3f::Zero();
  if (twice_area > 0) t.normal_world = (cross / twice_area).cast<float>();
  const Vec3 side = T_world_object.linear().inverse().transpose() * vertex_normal;
  if (side.dot(cross) < 0) t.normal_world = -t.normal_world;
  t.material = primitive.material;
  return t;
}

}  // namespace

PlacedTriangles::PlacedTriangles(const World& world) {
  all.reserve(world.triangle_count());
  for (size_t o = 0; o < world.objects.size(); ++o) {
    first_of_object.push_back(all.size());
    const Object& object = world.objects[o];
    for (const Primitive& primitive : world.meshes[static_cast<size_t>(object.mesh)].primitives) {
      const TextureTransform& transform =
          world.materials[static_cast<size_t>(primitive.material)].base_color_transform;
      for (const auto& corners : primitive.triangles) {
        all.push_back(placed(primitive, corners, object.T_world_object, transform));
        all.back().object = static_cast<uint32_t>(o);
      }
    }
  }
  first_of_object.push_back(all.size());
}

}  // namespace vsslam

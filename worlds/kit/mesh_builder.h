// Builds meshes from quads: vertices that agree to the bit are welded, triangles are grouped by material.
#pragma once

#include <array>
#include <map>
#include <string>
#include <unordered_map>

#include "worlds/world.h"

namespace vsslam {

struct Vertex {
  Vec3f position = Vec3f::Zero();
  Vec3f normal = Vec3f::UnitZ();
  Vec2f uv = Vec2f::Zero();
};

class MeshBuilder {
 public:
  /// Vertices counter-clockwise seen from outside.
  void triangle(int material, const Vertex& a, const Vertex& b, const Vertex& c);
  void quad(int material, const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d);

  /// A flat quad, textured by projection at `uv_per_m`: u to the right and v down, as seen by who faces it.
  void face(int material, const std::array<Vec3, 4>& corners, const Vec3& normal, double uv_per_m = 1);
  /// A box with its bottom at the centre of its foot, textured at `uv_per_m`.
  void box(int material, const Vec3& foot_m, const Vec3& size_m, double uv_per_m = 1);
  /// An upright closed cylinder or, with a second radius, a truncated cone.
  void cylinder(int material, const Vec3& foot_m, double radius_m, double top_radius_m, double height_m,
                int sides, double uv_per_m = 1);
  /// A truncated cone between any two points, smooth; `closed` adds flat ends.
  void limb(int material, const Vec3& from_m, const Vec3& to_m, double radius_m, double end_radius_m,
            int sides, bool closed, double uv_per_m = 1);
  /// A lumpy closed ball: a sphere of `rings` x 2 `rings` faces whose radius varies by `lumps`.
  void ball(int material, const Vec3& centre_m, double radius_m, int rings, double lumps, uint64_t seed);

  /// Primitives in order of material. The builder is empty afterwards.
  Mesh finish(std::string name);

 private:
  using Key = std::array<uint32_t, 8>;
  struct Hash {
    size_t operator()(const Key& key) const;
  };
  struct Part {
    Primitive primitive;
    std::unordered_map<Key, uint32_t, Hash> welded;  // looked up only, never iterated
  };
  static uint32_t weld(Part& part, const Vertex& vertex);

  std::map<int, Part> parts_;
};

}  // namespace vsslam

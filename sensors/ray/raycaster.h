// Rays against the world's triangles (Embree, one ISA so that results agree to the bit on every machine).
//
// Accuracy: Embree finds the triangle, in float; the range is then computed again in double from the plane of
// that triangle. What remains is the rounding of the ray itself to float: about 1e-7 of the distance from the
// world's origin, so 5e-6 m at 50 m.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "worlds/world.h"

namespace vsslam {

/// 16 rays in structure-of-arrays form, in world coordinates. Directions are unit vectors. A ray with
/// far < near is off.
struct alignas(64) RayPacket {
  static constexpr int kRays = 16;
  float origin_x[16], origin_y[16], origin_z[16];
  float direction_x[16], direction_y[16], direction_z[16];
  float near_m[16], far_m[16];
};

/// Answers of a packet; where nothing was hit, object == kNoHit and the other fields mean nothing.
struct alignas(64) HitPacket {
  static constexpr uint32_t kNoHit = 0xFFFFFFFFu;
  float range_m[16];
  uint32_t object[16];                             ///< index into World::objects
  uint32_t triangle[16];                           ///< index within the object, primitives one after another
  int material[16];                                ///< index into World::materials
  float u[16], v[16];                              ///< barycentric coordinates of the second and third vertex
  float normal_x[16], normal_y[16], normal_z[16];  ///< geometric, unit, world, towards the ray's origin
};

/// The least that shading needs; where nothing was hit, object == HitPacket::kNoHit.
struct alignas(64) SurfacePacket {
  float range_m[16];      ///< Embree's own: about 1e-6 of it
  uint32_t object[16];    ///< index into World::objects
  uint32_t triangle[16];  ///< index within the object, primitives one after another
  float u[16], v[16];     ///< barycentric coordinates of the second and third vertex
};

class Raycaster {
 public:
  /// The world must outlive the raycaster.
  explicit Raycaster(const World& world);
  ~Raycaster();
  Raycaster(const Raycaster&) = delete;
  Raycaster& operator=(const Raycaster&) = delete;

  /// Traces packets; coherent says that the rays of a packet lie close together. Thread-safe. The two spans
  /// are equally long.
  void trace(std::span<const RayPacket> rays, std::span<HitPacket> hits, bool coherent = true) const;
  void trace(std::span<const RayPacket> rays, std::span<SurfacePacket> surfaces, bool coherent = true) const;
  /// Bit i: something lies on ray i between its near_m and far_m.
  uint32_t occluded(const RayPacket& rays) const;
  /// One ray; returns false if nothing is hit. Convenience for oracles.
  struct Hit {
    double range_m;
    uint32_t object, triangle;
    Vec3 normal_world;  ///< unit, towards the origin of the ray
    int material;
  };
  bool trace_one(const Vec3& origin_world, const Vec3& direction_world, double max_range_m, Hit& hit) const;

  /// Material of a triangle of an object.
  int material(uint32_t object, uint32_t triangle) const;
  const World& world() const;

  /// Moves an object or takes it away; takes effect at commit(). Not thread-safe against trace. The first
  /// change of an object moves it to a scene of its own kind, after which changes cost only what moves.
  void set_object_pose(int object, const Eigen::Affine3d& T_world_object, bool present);
  void commit();
  /// What set_object_pose has moved so far.
  struct Moved {
    uint32_t object = 0;
    bool present = true;
    Vec3f low_world = Vec3f::Zero(), high_world = Vec3f::Zero();  ///< corners of its box where it is now
  };
  const std::vector<Moved>& moved() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

// Beams: what all rays of a tile hit, found together.
//
// A beam's rays start at one point and lie within four planes. It visits the boxes that it meets, near ones first, and
// tests eight triangles at a time against its four edges: one that lies outside is dropped, and of one that fills the
// beam only the distance is compared. With A, B, C the corners as seen from the origin, s = sign A.(B x C) and a ray d,
//
//   hit  <=>  s d.(B x C), s d.(C x A), s d.(A x B) >= 0,      1 / range = d.N / A.N  with  N = (B - A) x (C - A).
//
// Triangles that share an edge compute the same number for it but for its sign, so no ray slips between them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "sensors/ray/view_rays.h"
#include "sensors/render/triangle_tree.h"

namespace vsslam {

/// Rays of a tile in the world frame, from one origin.
struct alignas(32) Beam {
  static constexpr int kRays = RayTile::kRays;
  Vec3f origin, axis;                  ///< axis: unit, amid the rays
  float x[kRays], y[kRays], z[kRays];  ///< unit directions
  std::array<Vec3f, 4> corners;        ///< around the rays, turning one way
};
Beam beam_of(const RayTile& tile, const Vec3f& origin_world, const Eigen::Matrix3f& R_world_camera);

struct alignas(32) BeamHits {
  static constexpr uint32_t kNone = 0xFFFFFFFFu;
  float inverse_range[Beam::kRays];  ///< 1/m
  uint32_t triangle[Beam::kRays];    ///< index into PlacedTriangles::all, or kNone
};

/// Some triangles that stand elsewhere by now, and where.
struct MovedTriangles {
  uint32_t first = 0, end = 0;  ///< indices into PlacedTriangles::all
  bool present = true;
  Vec3f low_world = Vec3f::Zero(), high_world = Vec3f::Zero();  ///< corners of their box now
};

/// What the rays hit beyond `near_m`. False if there is too much in the beam to be worth it, or something that moved: then
/// the rays are to be traced one by one.
bool trace(const TriangleTree& tree, const Beam& beam, std::span<const MovedTriangles> moved, float near_m,
           BeamHits& hits);

}  // namespace vsslam

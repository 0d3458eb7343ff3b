// Boxes around triangles, eight in a node, and the triangles themselves, eight in a leaf: what a beam of rays tests at
// once with AVX2. World frame.
#pragma once

#include <cstdint>
#include <vector>

#include "sensors/surface/placed_triangles.h"

namespace vsslam {

struct alignas(32) TreeNode {
  float bounds[2][3][8];  ///< low and high corners of the children's boxes; low > high: no child
  int32_t child[8];       ///< a node, or ~leaf
};

struct alignas(32) TreeLeaf {
  float corners[3][3][8];  ///< [corner][axis][triangle]; all the same: no triangle
  uint32_t triangle[8];    ///< index into PlacedTriangles::all, unless renamed
};

struct TriangleTree {
  TriangleTree() = default;
  /// Splits where the surface area heuristic is least among 16 places. Triangles without area are left out.
  explicit TriangleTree(const PlacedTriangles& triangles);
  /// Has beams report names[triangle] instead of the triangle.
  void rename(const std::vector<uint32_t>& names);

  std::vector<TreeNode> nodes;  ///< the first is the root
  std::vector<TreeLeaf> leaves;
};

}  // namespace vsslam

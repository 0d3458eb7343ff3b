// Where light is stored: flat charts of connected triangles of one object, each with a grid of nodes.
//
// All triangles that meet at a vertex and face nearly the same way share a chart, whatever their material, so
// that light runs on without a seam from a wall to the door in it. A node whose place on the grid lies off the
// surface stands for the nearest point of the surface: nothing is taken from behind a wall.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sensors/surface/placed_triangles.h"

namespace vsslam {

struct LightMapCharts {
  /// A triangle's corners on its chart, in nodes; node (x, y) has index offset + y * stride + x.
  struct Place {
    uint32_t offset = 0, stride = 1;
    std::array<Vec2f, 3> corners;
  };
  struct Grid {
    uint32_t offset = 0, width = 1, height = 1;
  };
  /// A node that a surface point interpolates from, and the point where its light is measured.
  struct Site {
    uint32_t node = 0, triangle = 0;
    Vec3f position_world;  ///< a little above the surface and within its edges
    float u = 0, v = 0;    ///< barycentric coordinates of the second and third vertex
  };

  std::vector<Place> of_triangle;
  std::vector<Grid> grids;
  std::vector<Site> sites;  ///< in order of nodes
  size_t nodes = 0;
  double spacing_m = 0;  ///< of the nodes, at most
};

/// Where more than `max_nodes` would be needed, charts below 0.6 m get one node each, then the spacing grows (until
/// there is little more than one per chart).
LightMapCharts chart_surfaces(const PlacedTriangles& triangles, double spacing_m, size_t max_nodes);

}  // namespace vsslam

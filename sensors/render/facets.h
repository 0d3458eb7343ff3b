// Triangles that are drawn alike: they lie in one plane, and the texture and light of the first, continued, are theirs.
// A wall of many triangles is one facet, so that it can be shaded without looking for their edges.
#pragma once

#include <cstdint>
#include <vector>

#include "sensors/render/surface_records.h"
#include "sensors/surface/placed_triangles.h"

namespace vsslam {

/// Of each triangle, one that stands for it (of the same object and material): within 0.1 mm of its plane, 0.02 texels
/// and 0.001 nodes of the light map. Textures count modulo whole turns.
std::vector<uint32_t> facets(const PlacedTriangles& triangles, const std::vector<SurfaceRecord>& records);

}  // namespace vsslam

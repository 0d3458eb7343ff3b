// Trees and hedges: wood, and foliage of many small clusters of leaves, which rays partly pass between.
#pragma once

#include <cstdint>

#include "worlds/kit/mesh_builder.h"
#include "worlds/kit/outdoor_palette.h"

namespace vsslam {

/// Foot at the origin.
struct Tree {
  double height_m = 7.5;
  double crown_radius_m = 2.2;
  double trunk_radius_m = 0.13;
  int leaf_clusters = 1000;  ///< one triangle each
  double cluster_m = 0.3;    ///< size of a triangle
  int foliage = 0;           ///< which of the palette's
  uint64_t look = 1;
};

Mesh make_wood(const OutdoorPalette& palette, const Tree& tree);
Mesh make_foliage(const OutdoorPalette& palette, const Tree& tree);

/// 2 m of a trimmed hedge along y, 1 m high, about 0.6 m thick: a dense core with leaves around it.
Mesh make_hedge(const OutdoorPalette& palette, uint64_t look);

}  // namespace vsslam

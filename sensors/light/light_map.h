// Baked light: the illuminance of every surface by each group of lights, with shadows and diffuse bounces.
//
// The world is static and diffuse, so light is computed once: direct light by shadow rays, then E_k+1 =
// E_direct + pi mean(L_k) over cosine-distributed rays, L = emission + reflectance E / pi. The rays are traced
// once; bounces repeat the sum until it no longer changes.
#pragma once

#include <vector>

#include "sensors/light/light_sources.h"
#include "sensors/ray/raycaster.h"
#include "sensors/surface/light_map_charts.h"
#include "sensors/surface/texture_filter.h"

namespace vsslam {

/// What the light is computed in.
struct LitScene {
  const PlacedTriangles& triangles;
  const LightMapCharts& charts;
  const GreyTextures& textures;
  const LightSources& lights;
  const Raycaster& raycaster;
};

struct LightMap {
  size_t groups = 0;
  std::vector<float> illuminance;  ///< lux; node by node, the groups of a node beside each other

  /// The sum of all groups, each times its level; one value per node.
  std::vector<float> combined(const std::vector<float>& levels) const;
};

/// Same bytes for any number of threads.
LightMap bake_light_map(const LitScene& scene);

}  // namespace vsslam

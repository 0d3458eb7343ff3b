// What falls on surfaces, and what the sky sends where there are none; eight rays at once.
#pragma once

#include <vector>

#include "sensors/render/shading.h"
#include "sensors/surface/lane_vectors.h"

namespace vsslam {

/// Illuminance by the light map at chart coordinates (x, y), which must lie on the chart.
inline lanes::Floats baked_light(const std::vector<float>& nodes, lanes::Floats x, lanes::Floats y,
                                 lanes::Ints offset, lanes::Ints stride) {
  using namespace lanes;
  const Ints ix = truncated(x), iy = truncated(y);
  const Floats fx = x - floats(ix), fy = y - floats(iy);
  const Ints upper = offset + iy * stride + ix, lower = upper + stride;
  const Floats a = gather(nodes.data(), upper), b = gather(nodes.data(), upper + 1);
  const Floats c = gather(nodes.data(), lower), d = gather(nodes.data(), lower + 1);
  const Floats top = a + fx * (b - a);
  return top + fy * (c + fx * (d - c) - top);
}

/// Illuminance by a lamp beside the camera, so that it casts no shadow that the camera could see.
inline lanes::Floats headlight(const Surfaces& s, lanes::Floats range_m, lanes::Floats cos_axis,
                               lanes::Floats cos_surface) {
  using namespace lanes;
  const Floats edge =
      min(max((cos_axis - s.headlight_cos_outer) / (s.headlight_cos_inner - s.headlight_cos_outer), all(0)),
          all(1));
  const Floats distance = max(range_m, all(0.05f));
  return s.headlight_cd * edge * edge * cos_surface / (distance * distance);
}

/// Luminance of what lies behind everything, towards a unit direction in the world.
inline lanes::Floats sky_luminance(const Sky& sky, const lanes::Vectors& d) {
  using namespace lanes;
  const Floats dome = sky.zenith * (d.z > 0 ? (1.0f + 2.0f * d.z) / 3.0f : all(Sky::kBelowHorizon));
  // 2 (1 - cos a) is a^2 but for large angles.
  const Floats fall = 1.0f + 2.0f * (1.0f - d.dot(sky.to_sun)) / Sky::kGlowRadius2_rad2;
  return dome + sky.sun_lux * Sky::kGlow / (fall * fall);
}

}  // namespace vsslam

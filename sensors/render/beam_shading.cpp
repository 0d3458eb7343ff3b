#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "sensors/render/shading.h"
#include "sensors/render/surface_light.h"

namespace vsslam {

namespace {

using namespace lanes;

/// A triangle, and what is drawn on as it is (see facets.h), as one picture sees it: what does not change from ray to ray. Coordinates at a point of its plane, origin
/// + t d, are `at the origin` + t (gradient . d).
struct Facet {
  const SurfaceRecord& r;
  Vec3f u_gradient, v_gradient, light_x_gradient, light_y_gradient, normal;
  float u, v, light_x, light_y;            ///< at the origin; u, v in texels
  float u_right, u_down, v_right, v_down;  ///< texels per m along the picture's axes
  float plane_right, plane_down;           ///< n.axis / n.(corner - origin)

  Facet(const SurfaceRecord& record, const Viewpoint& view, const Vec3f& origin)
      : r(record),
        u_gradient(r.u_gradient),
        v_gradient(r.v_gradient),
        light_x_gradient(r.light_x_gradient),
        light_y_gradient(r.light_y_gradient),
        normal(r.normal) {
    const Vec3f back = origin - Vec3f(r.corner);
    u = r.uv[0][0] * r.width_px + u_gradient.dot(back);
    v = r.uv[0][1] * r.height_px + v_gradient.dot(back);
    light_x = r.light[0][0] + light_x_gradient.dot(back);
    light_y = r.light[0][1] + light_y_gradient.dot(back);
    u_right = u_gradient.dot(view.right), u_down = u_gradient.dot(view.down);
    v_right = v_gradient.dot(view.right), v_down = v_gradient.dot(view.down);
    const float height = -normal.dot(back);
    const float share = 1 / (std::abs(height) > 1e-6f ? height : 1e-6f);
    plane_right = share * normal.dot(view.right), plane_down = share * normal.dot(view.down);
  }
};

struct EightRays {
  Vectors d;
  Floats range_m, cos_axis;
};

Floats luminance(const Surfaces& s, const Viewpoint& view, const Facet& f, const EightRays& rays) {
  const Floats t = rays.range_m, scale = t * rays.cos_axis * view.pixel_angle_rad;
  const Floats du = t * rays.d.dot(f.u_gradient), dv = t * rays.d.dot(f.v_gradient);
  // With P = origin + t d, a change e of the ray's direction moves P by depth (e - d (n.e) / (n.d)).
  const GreyTextures::Footprint footprint{
      scale * (f.u_right - du * f.plane_right), scale * (f.v_right - dv * f.plane_right),
      scale * (f.u_down - du * f.plane_down), scale * (f.v_down - dv * f.plane_down)};
  const SurfaceRecord& r = f.r;
  const Floats reflectance =
      s.textures.sample(Ints{} + r.first_level, Ints{} + r.levels, all(r.width_px), all(r.height_px),
                        (f.u + du) * (1 / r.width_px), (f.v + dv) * (1 / r.height_px), footprint);
  const Floats x = f.light_x + t * rays.d.dot(f.light_x_gradient),
               y = f.light_y + t * rays.d.dot(f.light_y_gradient);
  Floats lux = baked_light(s.illuminance, min(max(x, all(0)), all(r.light_high[0])),
                           min(max(y, all(0)), all(r.light_high[1])), Ints{} + r.light_offset,
                           Ints{} + r.light_stride);
  if (s.headlight_cd > 0) {
    const Floats along_normal = rays.d.dot(f.normal);
    lux += headlight(s, t, rays.cos_axis, max(along_normal, -along_normal));
  }
  return r.luminance + reflectance * lux * (1 / std::numbers::pi_v<float>);
}

class TileShading {
 public:
  TileShading(const Surfaces& surfaces, const Viewpoint& view, const RayTile& tile, const Beam& beam,
              const BeamHits& hits, ShadedTile& shaded)
      : surfaces_(surfaces), view_(view), tile_(tile), beam_(beam), hits_(hits), shaded_(shaded) {}

  void run() {
    for (uint64_t pending = ~uint64_t{0}; pending != 0;) {
      const int first = std::countr_zero(pending);
      const uint32_t triangle = hits_.triangle[first];
      pending &= ~(triangle == BeamHits::kNone ? shade_sky(first) : shade_triangle(triangle, first));
    }
  }

 private:
  /// Calls of_rays(v) for all eights from `first` on in which this was hit, and keeps what it returns for those rays.
  template <class OfRays>
  uint64_t paint(uint32_t triangle, int first, const OfRays& of_rays) {
    uint64_t painted = 0;
    for (int v = first & ~(kLanes - 1); v < RayTile::kRays; v += kLanes) {
      const Ints on =
          load(reinterpret_cast<const int32_t*>(hits_.triangle + v)) == static_cast<int32_t>(triangle);
      const auto bits = static_cast<uint64_t>(_mm256_movemask_ps((__m256)on));
      if (bits == 0) continue;
      painted |= bits << v;
      const auto [luminance, depth_m] = of_rays(v);
      store(shaded_.luminance + v, on ? luminance : load(shaded_.luminance + v));
      store(shaded_.depth_m + v, on ? depth_m : load(shaded_.depth_m + v));
    }
    return painted;
  }

  Vectors directions(int v) const { return {load(beam_.x + v), load(beam_.y + v), load(beam_.z + v)}; }

  uint64_t shade_triangle(uint32_t triangle, int first) {
    const Facet facet(surfaces_.records[triangle], view_, beam_.origin);
    return paint(triangle, first, [&](int v) {
      const EightRays rays{directions(v), 1.0f / load(hits_.inverse_range + v), load(tile_.z + v)};
      return std::pair(luminance(surfaces_, view_, facet, rays), rays.range_m * rays.cos_axis);
    });
  }

  uint64_t shade_sky(int first) {
    return paint(BeamHits::kNone, first, [&](int v) {
      return std::pair(sky_luminance(surfaces_.sky, directions(v)),
                       all(std::numeric_limits<float>::infinity()));
    });
  }

  const Surfaces& surfaces_;
  const Viewpoint& view_;
  const RayTile& tile_;
  const Beam& beam_;
  const BeamHits& hits_;
  ShadedTile& shaded_;
};

}  // namespace

void shade(const Surfaces& surfaces, const Viewpoint& view, const RayTile& tile, const Beam& beam,
           const BeamHits& hits, ShadedTile& shaded) {
  TileShading(surfaces, view, tile, beam, hits, shaded).run();
}

}  // namespace vsslam

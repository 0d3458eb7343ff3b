#include "sensors/render/shading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sensors/render/surface_light.h"

namespace vsslam {

namespace {

using namespace lanes;

/// SurfaceRecord of eight rays; names and order are its own.
struct Rows {
  Floats coordinates[8], gradients[8], places[8], rest[8];

  explicit Rows(const float* const (&records)[8]) {
    transpose(records, 0, coordinates);
    transpose(records, 8, gradients);
    transpose(records, 16, places);
    transpose(records, 24, rest);
  }
  Floats width_px() const { return coordinates[6]; }
  Floats height_px() const { return coordinates[7]; }
  Vectors u_gradient() const { return {gradients[0], gradients[1], gradients[2]}; }
  Vectors v_gradient() const { return {gradients[3], gradients[4], gradients[5]}; }
  Floats luminance() const { return gradients[6]; }
  Ints first_level() const { return (Ints)gradients[7]; }
  Vectors normal() const { return {places[0], places[1], places[2]}; }
  Ints light_offset() const { return (Ints)rest[1]; }
  Ints light_stride() const { return (Ints)rest[2]; }
  Ints levels() const { return (Ints)rest[3]; }
  Floats texture_u(Floats u, Floats v) const {
    return blend(u, v, coordinates[0], coordinates[2], coordinates[4]);
  }
  Floats texture_v(Floats u, Floats v) const {
    return blend(u, v, coordinates[1], coordinates[3], coordinates[5]);
  }
  Floats light_x(Floats u, Floats v) const { return blend(u, v, places[3], places[5], places[7]); }
  Floats light_y(Floats u, Floats v) const { return blend(u, v, places[4], places[6], rest[0]); }

 private:
  static Floats blend(Floats u, Floats v, Floats a, Floats b, Floats c) {
    return (1.0f - u - v) * a + u * b + v * c;
  }
};

/// What the pixel's edges cover on the surface: with P = origin + t d on a plane of normal n, a change e of the
/// ray's direction moves P by depth (e - d (n.e) / (n.d)).
GreyTextures::Footprint footprint(const Rows& rows, const Viewpoint& view, const Vectors& d, Floats depth,
                                  Floats along_normal) {
  const Vectors n = rows.normal(), gu = rows.u_gradient(), gv = rows.v_gradient();
  const Floats grazing = all(1e-3f);
  const Floats safe = along_normal < 0 ? min(along_normal, -grazing) : max(along_normal, grazing);
  const Floats scale = depth * view.pixel_angle_rad;
  const Floats right = n.dot(view.right) / safe, down = n.dot(view.down) / safe;
  const Floats gu_d = gu.dot(d), gv_d = gv.dot(d);
  return {scale * (gu.dot(view.right) - gu_d * right), scale * (gv.dot(view.right) - gv_d * right),
          scale * (gu.dot(view.down) - gu_d * down), scale * (gv.dot(view.down) - gv_d * down)};
}

void shade_half(const Surfaces& s, const Viewpoint& view, const RayPacket& rays, const SurfacePacket& hits,
                int first, float* luminance, float* depth_m) {
  const float* records[8];
  for (int i = 0; i < 8; ++i) {
    const uint32_t object = hits.object[first + i];
    const bool hit = object != HitPacket::kNoHit;
    const size_t index = hit ? s.first_of_object[object] + hits.triangle[first + i] : s.records.size() - 1;
    records[i] = reinterpret_cast<const float*>(&s.records[index]);
  }
  const Rows rows(records);
  const Ints missed = load(reinterpret_cast<const int32_t*>(hits.object + first)) == -1;
  const Floats u = missed ? all(0) : load(hits.u + first), v = missed ? all(0) : load(hits.v + first);
  const Floats range = missed ? all(1) : load(hits.range_m + first);
  const Vectors d{load(rays.direction_x + first), load(rays.direction_y + first),
                  load(rays.direction_z + first)};
  const Floats along_normal = rows.normal().dot(d), cos_axis = d.dot(view.axis);
  const Floats depth = range * cos_axis;

  const Floats reflectance = s.textures.sample(rows.first_level(), rows.levels(), rows.width_px(),
                                               rows.height_px(), rows.texture_u(u, v), rows.texture_v(u, v),
                                               footprint(rows, view, d, depth, along_normal));
  Floats lux = baked_light(s.illuminance, rows.light_x(u, v), rows.light_y(u, v), rows.light_offset(),
                           rows.light_stride());
  if (s.headlight_cd > 0) lux += headlight(s, range, cos_axis, max(along_normal, -along_normal));
  const Floats surface = rows.luminance() + reflectance * lux * (1 / std::numbers::pi_v<float>);
  store(luminance + first, missed ? sky_luminance(s.sky, d) : surface);
  store(depth_m + first, missed ? all(std::numeric_limits<float>::infinity()) : depth);
}

}  // namespace

void shade(const Surfaces& surfaces, const Viewpoint& view, const RayPacket& rays, const SurfacePacket& hits,
           int first, ShadedTile& shaded) {
  for (int half : {0, kLanes})
    shade_half(surfaces, view, rays, hits, half, shaded.luminance + first, shaded.depth_m + first);
}

}  // namespace vsslam

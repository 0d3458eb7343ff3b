#include "sensors/shading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sensors/lanes.h"

namespace vsslam {

namespace {

using namespace lanes;

/// Vectors of eight rays.
struct Vectors {
  Floats x, y, z;
  Floats dot(const Vectors& o) const { return x * o.x + y * o.y + z * o.z; }
  Floats dot(const Vec3f& o) const { return x * o.x() + y * o.y() + z * o.z(); }
};

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

Floats baked_light(const std::vector<float>& nodes, const Rows& rows, Floats u, Floats v) {
  const Floats x = rows.light_x(u, v), y = rows.light_y(u, v);
  const Ints ix = truncated(x), iy = truncated(y);
  const Floats fx = x - floats(ix), fy = y - floats(iy);
  const Ints upper = rows.light_offset() + iy * rows.light_stride() + ix, lower = upper + rows.light_stride();
  const Floats a = gather(nodes.data(), upper), b = gather(nodes.data(), upper + 1);
  const Floats c = gather(nodes.data(), lower), d = gather(nodes.data(), lower + 1);
  const Floats top = a + fx * (b - a);
  return top + fy * (c + fx * (d - c) - top);
}

/// It sits beside the camera, so that it casts no shadow that the camera could see.
Floats headlight(const Surfaces& s, Floats range, Floats cos_axis, Floats cos_surface) {
  const Floats edge =
      min(max((cos_axis - s.headlight_cos_outer) / (s.headlight_cos_inner - s.headlight_cos_outer), all(0)),
          all(1));
  const Floats distance = max(range, all(0.05f));
  return s.headlight_cd * edge * edge * cos_surface / (distance * distance);
}

Floats sky_luminance(const Sky& sky, const Vectors& d) {
  const Floats dome = sky.zenith * (d.z > 0 ? (1.0f + 2.0f * d.z) / 3.0f : all(Sky::kBelowHorizon));
  // 2 (1 - cos a) is a^2 but for large angles.
  const Floats fall = 1.0f + 2.0f * (1.0f - d.dot(sky.to_sun)) / Sky::kGlowRadius2_rad2;
  return dome + sky.sun_lux * Sky::kGlow / (fall * fall);
}

void shade_half(const Surfaces& s, const Viewpoint& view, const RayPacket& rays, const SurfacePacket& hits,
                int first, ShadedPacket& shaded) {
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
  Floats lux = baked_light(s.illuminance, rows, u, v);
  if (s.headlight_cd > 0) lux += headlight(s, range, cos_axis, max(along_normal, -along_normal));
  const Floats surface = rows.luminance() + reflectance * lux * (1 / std::numbers::pi_v<float>);
  store(shaded.luminance + first, missed ? sky_luminance(s.sky, d) : surface);
  store(shaded.depth_m + first, missed ? all(std::numeric_limits<float>::infinity()) : depth);
}

/// Gradients over the triangle's plane of a quantity given at its corners.
Vec3f gradient(const PlacedTriangle& t, float a, float b, float c) {
  const Vec3 e1 = (t.corners_world[1] - t.corners_world[0]).cast<double>(),
             e2 = (t.corners_world[2] - t.corners_world[0]).cast<double>();
  const double e11 = e1.dot(e1), e12 = e1.dot(e2), e22 = e2.dot(e2), det = e11 * e22 - e12 * e12;
  if (!(det > 0)) return Vec3f::Zero();
  const double db = b - a, dc = c - a;
  return ((e1 * (e22 * db - e12 * dc) + e2 * (e11 * dc - e12 * db)) / det).cast<float>();
}

SurfaceRecord record_of(const PlacedTriangle& t, const LightMapCharts::Place& place, const Pyramid& pyramid) {
  SurfaceRecord r{};
  r.width_px = static_cast<float>(pyramid.width_px);
  r.height_px = static_cast<float>(pyramid.height_px);
  r.first_level = pyramid.first_level;
  r.levels = pyramid.levels;
  for (size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 2; ++i) {
      r.uv[k][i] = t.uv[k][i];
      r.light[k][i] = place.corners[k][i];
    }
  const Vec3f gu = r.width_px * gradient(t, t.uv[0].x(), t.uv[1].x(), t.uv[2].x());
  const Vec3f gv = r.height_px * gradient(t, t.uv[0].y(), t.uv[1].y(), t.uv[2].y());
  for (int i = 0; i < 3; ++i)
    r.u_gradient[i] = gu[i], r.v_gradient[i] = gv[i], r.normal[i] = t.normal_world[i];
  r.light_offset = static_cast<int32_t>(place.offset);
  r.light_stride = static_cast<int32_t>(place.stride);
  return r;
}

}  // namespace

std::vector<SurfaceRecord> surface_records(const PlacedTriangles& triangles, const LightMapCharts& charts,
                                           const GreyTextures& textures) {
  std::vector<SurfaceRecord> records;
  records.reserve(triangles.all.size() + 1);
  for (size_t t = 0; t < triangles.all.size(); ++t)
    records.push_back(
        record_of(triangles.all[t], charts.of_triangle[t], textures.of_material(triangles.all[t].material)));
  SurfaceRecord nothing{};
  nothing.width_px = nothing.height_px = 1;
  nothing.levels = nothing.light_stride = 1;
  records.push_back(nothing);
  return records;
}

void shade(const Surfaces& surfaces, const Viewpoint& view, const RayPacket& rays, const SurfacePacket& hits,
           ShadedPacket& shaded) {
  shade_half(surfaces, view, rays, hits, 0, shaded);
  shade_half(surfaces, view, rays, hits, 8, shaded);
}

}  // namespace vsslam

#include "sensors/render/surface_records.h"

#include <algorithm>

namespace vsslam {

namespace {

/// Gradients over the triangle's plane of a quantity given at its corners.
Vec3f gradient(const PlacedTriangle& t, float a, float b, float c) {
  const Vec3 e1 = (t.corners_world[1] - t.corners_world[0]).cast<double>(),
             e2 = (t.corners_world[2] - t.corners_world[0]).cast<double>();
  const double e11 = e1.dot(e1), e12 = e1.dot(e2), e22 = e2.dot(e2), det = e11 * e22 - e12 * e12;
  if (!(det > 0)) return Vec3f::Zero();
  const double db = b - a, dc = c - a;
  return ((e1 * (e22 * db - e12 * dc) + e2 * (e11 * dc - e12 * db)) / det).cast<float>();
}

const LightMapCharts::Grid& grid_of(const LightMapCharts& charts, const LightMapCharts::Place& place) {
  return *(std::upper_bound(charts.grids.begin(), charts.grids.end(), place.offset,
                            [](uint32_t offset, const auto& grid) { return offset < grid.offset; }) -
           1);
}

SurfaceRecord record_of(const PlacedTriangle& t, const LightMapCharts::Place& place,
                        const LightMapCharts::Grid& grid, const Pyramid& pyramid) {
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
  const Vec3f gx = gradient(t, place.corners[0].x(), place.corners[1].x(), place.corners[2].x());
  const Vec3f gy = gradient(t, place.corners[0].y(), place.corners[1].y(), place.corners[2].y());
  for (int i = 0; i < 3; ++i)
    r.light_x_gradient[i] = gx[i], r.light_y_gradient[i] = gy[i], r.corner[i] = t.corners_world[0][i];
  r.light_offset = static_cast<int32_t>(place.offset);
  r.light_stride = static_cast<int32_t>(place.stride);
  r.light_high[0] = static_cast<float>(grid.width - 1);
  r.light_high[1] = static_cast<float>(grid.height - 1);
  return r;
}

}  // namespace

std::vector<SurfaceRecord> surface_records(const PlacedTriangles& triangles, const LightMapCharts& charts,
                                           const GreyTextures& textures) {
  std::vector<SurfaceRecord> records;
  records.reserve(triangles.all.size() + 1);
  for (size_t t = 0; t < triangles.all.size(); ++t)
    records.push_back(record_of(triangles.all[t], charts.of_triangle[t],
                                grid_of(charts, charts.of_triangle[t]),
                                textures.of_material(triangles.all[t].material)));
  SurfaceRecord nothing{};
  nothing.width_px = nothing.height_px = 1;
  nothing.levels = nothing.light_stride = 1;
  records.push_back(nothing);
  return records;
}

}  // namespace vsslam

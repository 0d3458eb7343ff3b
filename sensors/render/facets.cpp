#include "sensors/render/facets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace vsslam {

namespace {

constexpr float kOffPlane_m = 1e-4f, kOffTexture_px = 0.02f, kOffLight_nodes = 1e-3f;
constexpr size_t kRecent = 4;  // a curved surface has many: only the last are tried

/// What a facet says of points of another triangle, against what that triangle says.
class Continuation {
 public:
  explicit Continuation(const SurfaceRecord& facet) : f_(facet) {}

  bool holds(const PlacedTriangle& triangle, const SurfaceRecord& record) const {
    const Vec2f turns = texture_error_px(triangle, record, 0).cwiseQuotient(size_px()).array().round();
    for (size_t k = 0; k < 3; ++k) {
      const Vec3f from = offset(triangle, k);
      const Vec2f light(f_.light[0][0] + Vec3f(f_.light_x_gradient).dot(from) - record.light[k][0],
                        f_.light[0][1] + Vec3f(f_.light_y_gradient).dot(from) - record.light[k][1]);
      const Vec2f texture = texture_error_px(triangle, record, k) - turns.cwiseProduct(size_px());
      if (!(std::abs(Vec3f(f_.normal).dot(from)) < kOffPlane_m &&
            light.cwiseAbs().maxCoeff() < kOffLight_nodes && texture.cwiseAbs().maxCoeff() < kOffTexture_px))
        return false;
    }
    return true;
  }

 private:
  Vec2f size_px() const { return {f_.width_px, f_.height_px}; }
  Vec3f offset(const PlacedTriangle& triangle, size_t corner) const {
    return triangle.corners_world[corner] - Vec3f(f_.corner);
  }
  Vec2f texture_error_px(const PlacedTriangle& triangle, const SurfaceRecord& record, size_t k) const {
    const Vec3f from = offset(triangle, k);
    return {(f_.uv[0][0] - record.uv[k][0]) * f_.width_px + Vec3f(f_.u_gradient).dot(from),
            (f_.uv[0][1] - record.uv[k][1]) * f_.height_px + Vec3f(f_.v_gradient).dot(from)};
  }

  const SurfaceRecord& f_;
};

}  // namespace

std::vector<uint32_t> facets(const PlacedTriangles& triangles, const std::vector<SurfaceRecord>& records) {
  using Kind = std::pair<int, int32_t>;           // material, chart
  std::map<Kind, std::vector<uint32_t>> of_kind;  // of one object
  std::vector<uint32_t> facet_of;
  facet_of.reserve(triangles.all.size());
  for (uint32_t t = 0; t < triangles.all.size(); ++t) {
    const PlacedTriangle& triangle = triangles.all[t];
    if (t > 0 && triangle.object != triangles.all[t - 1].object) of_kind.clear();
    std::vector<uint32_t>& recent = of_kind[{triangle.material, records[t].light_offset}];
    const auto same = std::find_if(recent.rbegin(), recent.rend(), [&](uint32_t facet) {
      return Continuation(records[facet]).holds(triangle, records[t]);
    });
    facet_of.push_back(same == recent.rend() ? t : *same);
    if (same != recent.rend()) continue;
    if (recent.size() == kRecent) recent.erase(recent.begin());
    recent.push_back(t);
  }
  return facet_of;
}

}  // namespace vsslam

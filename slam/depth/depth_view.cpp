#include "slam/depth/depth_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace vsslam {

void DepthViewConfig::fields(Fields& f) {
  f("bin_deg", bin_deg, between(0.05, 5));
  f("search_deg", search_deg, between(0.1, 20));
  f("max_spread_m", max_spread_m, positive());
  f("min_graze_deg", min_graze_deg, between(0, 90));
  f("surface_m", surface_m, positive());
  f("surface_share", surface_share, between(0, 1));
}

namespace {

constexpr float kEmpty = std::numeric_limits<float>::infinity();

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

// Which sixth of the plane (a, b) is in, counted against the clock from a = 1, b = 0.
int sextant(float a, float b) {
  const float slope = std::numbers::sqrt3_v<float> * std::abs(a);
  const bool upper = b > 0 || (b == 0 && a >= 0);
  if (std::abs(b) >= slope) return upper ? 1 : 4;
  return upper ? (a > 0 ? 0 : 2) : (a < 0 ? 3 : 5);
}

}  // namespace

// A point beside a ray. (a, b): where its direction crosses the plane at distance 1 across the ray.
struct DepthView::Neighbour {
  Eigen::Vector3f point;
  float a, b;

  float distance2() const { return a * a + b * b; }
};

// The plane through three points that enclose a ray.
struct DepthView::Surface {
  Eigen::Vector3f normal;  // towards the camera
  float offset_m;          // normal . point, negative
  float spread_m;          // of the three points' depths
  float reach2;            // largest distance2 of the three

  Surface(const Neighbour& a, const Neighbour& b, const Neighbour& c)
      : normal((b.point - a.point).cross(c.point - a.point).normalized()),
        spread_m(std::max({a.point.z(), b.point.z(), c.point.z()}) -
                 std::min({a.point.z(), b.point.z(), c.point.z()})),
        reach2(std::max({a.distance2(), b.distance2(), c.distance2()})) {
    if (normal.dot(a.point) > 0) normal = -normal;
    offset_m = normal.dot(a.point);
  }
  // Positive: on the camera's side.
  float height_m(const Eigen::Vector3f& point) const { return normal.dot(point) - offset_m; }
};

namespace {

using Three = std::array<size_t, 3>;

// The three points that enclose the ray whose farthest is nearest to it, out of the nearest of each sextant.
template <class Neighbour>
std::optional<Three> nearest_three_around(const std::vector<Neighbour>& points) {
  constexpr size_t kNone = static_cast<size_t>(-1);
  std::array<size_t, 6> nearest;
  nearest.fill(kNone);
  for (size_t i = 0; i < points.size(); ++i) {
    size_t& best = nearest[static_cast<size_t>(sextant(points[i].a, points[i].b))];
    if (best == kNone || points[i].distance2() < points[best].distance2()) best = i;
  }
  const auto turn = [&](size_t i, size_t j) { return points[i].a * points[j].b - points[j].a * points[i].b; };
  std::optional<Three> best;
  float best_distance2 = kEmpty;
  for (size_t s = 0; s < 6; ++s)
    for (size_t t = s + 1; t < 6; ++t)
      for (size_t u = t + 1; u < 6; ++u) {
        const size_t i = nearest[s], j = nearest[t], k = nearest[u];
        if (i == kNone || j == kNone || k == kNone) continue;
        const float ij = turn(i, j), jk = turn(j, k), ki = turn(k, i);
        if (ij < 0 || jk < 0 || ki < 0 || ij + jk + ki < 1e-9f) continue;
        const float farthest2 =
            std::max({points[i].distance2(), points[j].distance2(), points[k].distance2()});
        if (farthest2 >= best_distance2) continue;
        best_distance2 = farthest2;
        best = Three{i, j, k};
      }
  return best;
}

}  // namespace

DepthView::DepthView(const DepthViewConfig& config, const Eigen::Vector2f& extent)
    : config_(config),
      extent_(extent),
      bins_per_tangent_(static_cast<float>(1 / std::tan(radians(config.bin_deg)))) {
  columns_ = std::ceil(2 * extent.x() * bins_per_tangent_);
  rows_ = std::ceil(2 * extent.y() * bins_per_tangent_);
  stride_ = static_cast<int>(columns_);
  bins_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), Eigen::Vector3f(0, 0, kEmpty));
}

std::vector<DepthView::Neighbour> DepthView::neighbours(const Eigen::Vector2f& ray) const {
  const Eigen::Vector3f forward = Eigen::Vector3f(ray.x(), ray.y(), 1).normalized();
  const Eigen::Vector3f right = Eigen::Vector3f(1, 0, -ray.x()).normalized(), down = forward.cross(right);
  const auto radius = static_cast<float>(std::tan(radians(config_.search_deg)));
  const float reach =
      radius * (1 + ray.squaredNorm()) * bins_per_tangent_;  // an angle spans more bins off the axis
  const float column = (ray.x() + extent_.x()) * bins_per_tangent_,
              row = (ray.y() + extent_.y()) * bins_per_tangent_;
  const auto first = [&](float at) { return static_cast<int>(std::max(at - reach, 0.0f)); };
  const auto last = [&](float at, float count) { return static_cast<int>(std::min(at + reach, count - 1)); };

  std::vector<Neighbour> result;
  for (int y = first(row); y <= last(row, rows_); ++y)
    for (int x = first(column); x <= last(column, columns_); ++x) {
      const Eigen::Vector3f& point = bins_[static_cast<size_t>(y * stride_ + x)];
      if (point.z() == kEmpty) continue;
      const float along = point.dot(forward);
      const Neighbour neighbour{point, point.dot(right) / along, point.dot(down) / along};
      if (along > 0 && neighbour.distance2() < radius * radius) result.push_back(neighbour);
    }
  return result;
}

float DepthView::tolerance_m(const Eigen::Vector3f& point) const {
  return static_cast<float>(config_.surface_m) + static_cast<float>(config_.surface_share) * point.norm();
}

// On more than one side of the ray: no three empty sextants beside each other.
bool DepthView::surrounds(const std::vector<Neighbour>& points) const {
  if (points.size() < 3) return false;
  unsigned mask = 0;
  for (const Neighbour& p : points) mask |= 1u << sextant(p.a, p.b);
  mask |= mask << 6;
  for (unsigned s = 0; s < 6; ++s)
    if ((mask >> s & 7u) == 0) return false;
  return true;
}

std::optional<double> DepthView::depth_m(const Eigen::Vector2f& ray_camera) const {
  if (!(ray_camera.cwiseAbs().array() <= extent_.array()).all()) return std::nullopt;
  const Eigen::Vector3f ray(ray_camera.x(), ray_camera.y(), 1);
  std::vector<Neighbour> around = neighbours(ray_camera);
  constexpr int kLayers = 3;
  for (int layer = 0; layer < kLayers; ++layer) {
    const std::optional<Three> three = nearest_three_around(around);
    if (!three) return std::nullopt;
    const Surface surface(around[(*three)[0]], around[(*three)[1]], around[(*three)[2]]);
    std::vector<Neighbour> before = points_before(surface, around);
    if (!surrounds(before)) {
      if (!supports(around, surface, ray)) return std::nullopt;
      return surface.offset_m / surface.normal.dot(ray);
    }
    // Old points behind a surface show between its scan lines; what surrounds the ray hides them.
    around = std::move(before);
  }
  return std::nullopt;
}

std::vector<DepthView::Neighbour> DepthView::points_before(const Surface& surface,
                                                           const std::vector<Neighbour>& points) const {
  std::vector<Neighbour> result;
  for (const Neighbour& p : points)
    if (surface.height_m(p.point) > tolerance_m(p.point)) result.push_back(p);
  return result;
}

bool DepthView::supports(const std::vector<Neighbour>& points, const Surface& surface,
                         const Eigen::Vector3f& ray) const {
  if (!(surface.spread_m <= config_.max_spread_m)) return false;
  const float sine_of_graze = -surface.normal.dot(ray.normalized());
  if (!(sine_of_graze >= std::sin(radians(config_.min_graze_deg)))) return false;
  return std::none_of(points.begin(), points.end(), [&](const Neighbour& p) {  // else an edge is here
    return p.distance2() <= surface.reach2 && std::abs(surface.height_m(p.point)) > tolerance_m(p.point);
  });
}

}  // namespace vsslam

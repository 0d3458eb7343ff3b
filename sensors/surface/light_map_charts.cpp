#include "sensors/surface/light_map_charts.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/ordered_parallel.h"

namespace vsslam {

namespace {

constexpr float kSameFacing = 0.99f;  // cosine: 8 degrees
constexpr float kAboveSurface_m = 1e-3f, kWithinEdges_m = 3e-3f;

/// Triangles around each vertex; vertices agree if their positions do, to the bit.
class Neighbours {
 public:
  Neighbours(const PlacedTriangles& triangles, size_t begin, size_t end) : begin_(begin) {
    for (size_t t = begin; t < end; ++t)
      for (const Vec3f& corner : triangles.all[t].corners_world)
        corners_.push_back(
            {{std::bit_cast<uint32_t>(corner.x() + 0.0f), std::bit_cast<uint32_t>(corner.y() + 0.0f),
              std::bit_cast<uint32_t>(corner.z() + 0.0f)},
             static_cast<uint32_t>(corners_.size())});
    std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) {
      return a.position != b.position ? a.position < b.position : a.corner < b.corner;
    });
    fan_of_corner_.resize(corners_.size());
    for (size_t i = 0, first = 0; i < corners_.size(); ++i) {
      if (corners_[i].position != corners_[first].position) first = i;
      fan_of_corner_[corners_[i].corner] = static_cast<uint32_t>(first);
    }
  }
  /// Calls visit(other) for all triangles that share a vertex with this one, itself included.
  template <class Visit>
  void around(size_t triangle, const Visit& visit) const {
    for (size_t k = 0; k < 3; ++k) {
      const size_t first = fan_of_corner_[3 * (triangle - begin_) + k];
      for (size_t i = first; i < corners_.size() && corners_[i].position == corners_[first].position; ++i)
        visit(begin_ + corners_[i].corner / 3);
    }
  }

 private:
  struct Corner {
    std::array<uint32_t, 3> position;
    uint32_t corner;
  };
  size_t begin_;
  std::vector<Corner> corners_;
  std::vector<uint32_t> fan_of_corner_;
};

/// Connected triangles that face as their first one does, and the plane they are drawn on.
struct Chart {
  std::vector<size_t> triangles;
  Vec3f right, down;
  Vec2f low, extent_m;
};

Chart frame_chart(const PlacedTriangles& all, std::vector<size_t> members) {
  Chart chart{std::move(members), Vec3f::UnitX(), Vec3f::UnitY(), Vec2f::Constant(1e30f), Vec2f::Zero()};
  const Vec3f& n = all.all[chart.triangles.front()].normal_world;
  if (n.squaredNorm() > 0.5f) {  // level charts lie along x, others along the horizontal
    chart.right = std::abs(n.z()) > 0.9f ? Vec3f(Vec3f::UnitX() - n.x() * n).normalized()
                                         : Vec3f(Vec3f::UnitZ().cross(n)).normalized();
    chart.down = n.cross(chart.right);
  }
  Vec2f high = -chart.low;
  for (const size_t t : chart.triangles)
    for (const Vec3f& p : all.all[t].corners_world) {
      const Vec2f at(chart.right.dot(p), chart.down.dot(p));
      chart.low = chart.low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  chart.extent_m = high - chart.low;
  return chart;
}

std::vector<Chart> charts_of_object(const PlacedTriangles& all, size_t begin, size_t end) {
  const Neighbours neighbours(all, begin, end);
  std::vector<bool> taken(end - begin, false);
  std::vector<Chart> charts;
  for (size_t seed = begin; seed < end; ++seed) {
    if (taken[seed - begin]) continue;
    std::vector<size_t> members{seed};
    taken[seed - begin] = true;
    for (size_t i = 0; i < members.size(); ++i)
      neighbours.around(members[i], [&](size_t other) {
        if (taken[other - begin]) return;
        if (all.all[other].normal_world.dot(all.all[seed].normal_world) < kSameFacing) return;
        taken[other - begin] = true;
        members.push_back(other);
      });
    std::sort(members.begin(), members.end());
    charts.push_back(frame_chart(all, std::move(members)));
  }
  return charts;
}

uint32_t nodes_along(float extent_m, double spacing_m) {
  if (extent_m < 0.5 * spacing_m) return 1;
  return static_cast<uint32_t>(std::ceil(extent_m / spacing_m)) + 1;
}

/// How densely charts are covered.
struct Density {
  double spacing_m;
  float single_below_m = 0;  ///< charts that are smaller both ways have one node
};

LightMapCharts::Grid grid_of(const Chart& c, const Density& density) {
  if (c.extent_m.maxCoeff() < density.single_below_m) return {};
  return {.width = nodes_along(c.extent_m.x(), density.spacing_m),
          .height = nodes_along(c.extent_m.y(), density.spacing_m)};
}

size_t node_count(const std::vector<Chart>& charts, const Density& density) {
  size_t count = 0;
  for (const Chart& c : charts) {
    const LightMapCharts::Grid grid = grid_of(c, density);
    count += size_t{grid.width} * grid.height;
  }
  return count;
}

/// In worlds beyond the budget leaves and twigs make do with one node before large surfaces get coarser.
Density affordable(const std::vector<Chart>& charts, double spacing_m, size_t max_nodes) {
  constexpr float kSmall_m = 0.6f;
  Density density{spacing_m};
  const size_t allowed = std::max(max_nodes, charts.size() + charts.size() / 2);
  if (node_count(charts, density) > allowed) density.single_below_m = kSmall_m;
  while (node_count(charts, density) > allowed) density.spacing_m *= 1.1;
  return density;
}

/// Barycentric coordinates of the point of a flat triangle that is nearest to p.
Vec2f nearest_in(const std::array<Vec2f, 3>& c, const Vec2f& p) {
  const Vec2f e1 = c[1] - c[0], e2 = c[2] - c[0], d = p - c[0];
  const float det = e1.x() * e2.y() - e1.y() * e2.x();
  if (std::abs(det) > 1e-12f) {
    const float u = (d.x() * e2.y() - d.y() * e2.x()) / det, v = (e1.x() * d.y() - e1.y() * d.x()) / det;
    if (u >= 0 && v >= 0 && u + v <= 1) return {u, v};
  }
  const Vec2f barycentric[3] = {{0, 0}, {1, 0}, {0, 1}};
  Vec2f best = barycentric[0];
  float best_distance = 1e30f;
  for (size_t k = 0; k < 3; ++k) {
    const Vec2f a = c[k], edge = c[(k + 1) % 3] - a;
    const float length2 = edge.squaredNorm();
    const float t = length2 > 0 ? std::clamp((p - a).dot(edge) / length2, 0.0f, 1.0f) : 0.0f;
    const float distance = (a + t * edge - p).squaredNorm();
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = barycentric[k] + t * (barycentric[(k + 1) % 3] - barycentric[k]);
  }
  return best;
}

LightMapCharts::Site site_at(const PlacedTriangle& triangle, uint32_t node, size_t index, const Vec2f& uv) {
  const auto& c = triangle.corners_world;
  Vec3f at = (1 - uv.x() - uv.y()) * c[0] + uv.x() * c[1] + uv.y() * c[2];
  const Vec3f inwards = (c[0] + c[1] + c[2]) / 3 - at;
  at += std::min(1.0f, kWithinEdges_m / std::max(1e-9f, inwards.norm())) * inwards;
  at += kAboveSurface_m * triangle.normal_world;
  return {node, static_cast<uint32_t>(index), at, uv.x(), uv.y()};
}

/// The nodes of a chart that its surface interpolates from, each at the nearest point of the surface.
std::vector<LightMapCharts::Site> sites_of(const PlacedTriangles& all, const LightMapCharts& charts,
                                           const LightMapCharts::Grid& grid, const Chart& chart) {
  struct Nearest {
    float distance = 1e30f;
    size_t triangle = 0;
    Vec2f uv;
  };
  if (grid.width == 1 && grid.height == 1) {
    const size_t largest =
        *std::max_element(chart.triangles.begin(), chart.triangles.end(),
                          [&](size_t a, size_t b) { return all.all[a].area_m2 < all.all[b].area_m2; });
    return {site_at(all.all[largest], grid.offset, largest, Vec2f::Constant(1.0f / 3))};
  }
  std::vector<Nearest> nearest(size_t{grid.width} * grid.height);
  for (const size_t t : chart.triangles) {
    const std::array<Vec2f, 3>& c = charts.of_triangle[t].corners;
    const Vec2f low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    const auto first = [](float x) { return static_cast<uint32_t>(std::max(0.0f, std::ceil(x - 1))); };
    const auto last = [](float x, uint32_t n) {
      return std::min(n - 1, static_cast<uint32_t>(std::max(0.0f, x + 1)));
    };
    for (uint32_t y = first(low.y()); y <= last(high.y(), grid.height); ++y)
      for (uint32_t x = first(low.x()); x <= last(high.x(), grid.width); ++x) {
        const Vec2f node(static_cast<float>(x), static_cast<float>(y));
        const Vec2f uv = nearest_in(c, node);
        const Vec2f off = (1 - uv.x() - uv.y()) * c[0] + uv.x() * c[1] + uv.y() * c[2] - node;
        if (std::abs(off.x()) > 1 || std::abs(off.y()) > 1) continue;
        Nearest& best = nearest[size_t{y} * grid.width + x];
        if (off.squaredNorm() < best.distance) best = {off.squaredNorm(), t, uv};
      }
  }
  std::vector<LightMapCharts::Site> sites;
  for (size_t i = 0; i < nearest.size(); ++i)
    if (nearest[i].distance < 1e30f)
      sites.push_back(site_at(all.all[nearest[i].triangle], grid.offset + static_cast<uint32_t>(i),
                              nearest[i].triangle, nearest[i].uv));
  return sites;
}

void place(const Chart& chart, const PlacedTriangles& all, LightMapCharts::Grid grid,
           LightMapCharts& charts) {
  grid.offset = static_cast<uint32_t>(charts.nodes);
  const Vec2f nodes_per_m(grid.width > 1 ? static_cast<float>(grid.width - 1) / chart.extent_m.x() : 0.0f,
                          grid.height > 1 ? static_cast<float>(grid.height - 1) / chart.extent_m.y() : 0.0f);
  for (const size_t t : chart.triangles) {
    LightMapCharts::Place& place = charts.of_triangle[t];
    place.offset = grid.offset;
    place.stride = grid.width;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3f& p = all.all[t].corners_world[k];
      place.corners[k] = (Vec2f(chart.right.dot(p), chart.down.dot(p)) - chart.low).cwiseProduct(nodes_per_m);
    }
  }
  charts.grids.push_back(grid);
  charts.nodes += size_t{grid.width} * grid.height;
}

}  // namespace

LightMapCharts chart_surfaces(const PlacedTriangles& all, double spacing_m, size_t max_nodes) {
  const size_t objects = all.first_of_object.size() - 1;
  std::vector<std::vector<Chart>> of_object(objects);
  parallel_pieces(objects, 1, [&](size_t begin, size_t end) {
    for (size_t o = begin; o < end; ++o)
      of_object[o] = charts_of_object(all, all.first_of_object[o], all.first_of_object[o + 1]);
  });
  std::vector<Chart> charts;
  for (std::vector<Chart>& some : of_object) std::move(some.begin(), some.end(), std::back_inserter(charts));

  LightMapCharts result;
  const Density density = affordable(charts, spacing_m, max_nodes);
  result.spacing_m = density.spacing_m;
  result.of_triangle.resize(all.all.size());
  for (const Chart& chart : charts) place(chart, all, grid_of(chart, density), result);

  std::vector<std::vector<LightMapCharts::Site>> sites(charts.size());
  parallel_pieces(charts.size(), 16, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sites[i] = sites_of(all, result, result.grids[i], charts[i]);
  });
  for (const auto& some : sites) result.sites.insert(result.sites.end(), some.begin(), some.end());
  return result;
}

}  // namespace vsslam

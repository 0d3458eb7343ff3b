#include "scenarios/oracles/map_error.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "core/ordered_parallel.h"

namespace vsslam {

namespace {

struct Triangle {
  Vec3 a, b, c;
  Vec3 centre() const { return (a + b + c) / 3; }
};

/// Squared distance from p to a triangle, by the Voronoi region that p lies in (Ericson, Real-Time Collision
/// Detection, section 5.1.5).
double squared_distance(const Vec3& p, const Triangle& t) {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Vec3 bp = p - t.b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const Vec3 cp = p - t.c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t.c - t.b)).squaredNorm();
  const double scale = 1 / (va + vb + vc);
  return (ap - vb * scale * ab - vc * scale * ac).squaredNorm();
}

std::vector<Triangle> world_triangles(const World& world) {
  std::vector<Triangle> triangles;
  triangles.reserve(world.triangle_count());
  for (const Object& object : world.objects)
    for (const Primitive& primitive : world.meshes[static_cast<size_t>(object.mesh)].primitives)
      for (const auto& corners : primitive.triangles) {
        const auto corner = [&](int i) -> Vec3 {
          return object.T_world_object * primitive.positions[corners[static_cast<size_t>(i)]].cast<double>();
        };
        triangles.push_back({corner(0), corner(1), corner(2)});
      }
  return triangles;
}

}  // namespace

/// Boxes over triangles, halved at the median of the longest side. Nodes lie depth-first: the left child
/// follows its parent.
struct SurfaceDistance::Tree {
  static constexpr uint32_t kLeafSize = 4;
  struct Node {
    Eigen::AlignedBox3d box;
    uint32_t begin = 0, end = 0;  // triangles
    uint32_t right = 0;           // 0: leaf
  };
  std::vector<Triangle> triangles;
  std::vector<Node> nodes;

  explicit Tree(std::vector<Triangle> all) : triangles(std::move(all)) {
    if (!triangles.empty()) build(0, static_cast<uint32_t>(triangles.size()));
  }

  uint32_t build(uint32_t begin, uint32_t end) {
    const auto index = static_cast<uint32_t>(nodes.size());
    nodes.push_back({.box = {}, .begin = begin, .end = end, .right = 0});
    Eigen::AlignedBox3d box, centres;
    for (uint32_t i = begin; i < end; ++i) {
      for (const Vec3& corner : {triangles[i].a, triangles[i].b, triangles[i].c}) box.extend(corner);
      centres.extend(triangles[i].centre());
    }
    nodes[index].box = box;
    if (end - begin <= kLeafSize) return index;
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(
        triangles.begin() + begin, triangles.begin() + middle, triangles.begin() + end,
        [axis](const Triangle& a, const Triangle& b) { return a.centre()[axis] < b.centre()[axis]; });
    build(begin, middle);
    const uint32_t right = build(middle, end);
    nodes[index].right = right;
    return index;
  }

  void nearest(uint32_t index, const Vec3& p, double& best) const {
    const Node& node = nodes[index];
    if (node.right == 0) {
      for (uint32_t i = node.begin; i < node.end; ++i)
        best = std::min(best, squared_distance(p, triangles[i]));
      return;
    }
    std::array<std::pair<double, uint32_t>, 2> children;
    children[0] = {nodes[index + 1].box.squaredExteriorDistance(p), index + 1};
    children[1] = {nodes[node.right].box.squaredExteriorDistance(p), node.right};
    if (children[1].first < children[0].first) std::swap(children[0], children[1]);
    for (const auto& [distance, child] : children)
      if (distance < best) nearest(child, p, best);
  }
};

SurfaceDistance::SurfaceDistance(const World& world)
    : tree_(std::make_unique<Tree>(world_triangles(world))) {}
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance::~SurfaceDistance() = default;

double SurfaceDistance::operator()(const Vec3& point_world) const {
  double best = std::numeric_limits<double>::infinity();
  if (!tree_->nodes.empty()) tree_->nearest(0, point_world, best);
  return std::sqrt(best);
}

MapError map_error(const Cloud& points_map, const SE3& T_world_map, const SurfaceDistance& surface,
                   size_t max_points) {
  const size_t stride =
      std::max<size_t>(1, (points_map.size() + max_points - 1) / std::max<size_t>(1, max_points));
  std::vector<double> distances((points_map.size() + stride - 1) / stride);
  parallel_pieces(distances.size(), 256, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      distances[i] = surface(T_world_map * points_map[i * stride].cast<double>());
  });
  MapError error{.mean_m = 0, .max_m = 0, .points = distances.size()};
  if (distances.empty()) return error;
  error.mean_m =
      std::accumulate(distances.begin(), distances.end(), 0.0) / static_cast<double>(distances.size());
  error.max_m = *std::max_element(distances.begin(), distances.end());
  return error;
}

}  // namespace vsslam

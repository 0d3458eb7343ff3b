#include "sensors/render/beam.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "sensors/surface/lane_vectors.h"

namespace vsslam {

namespace {

using namespace lanes;

constexpr float kFarthest_m = 1e5f;
// Beyond so much work, rays one by one are faster.
constexpr int kMostVisits = 100, kMostTests = 40;

/// A plane through the beam's origin against boxes: the corner of a box that lies farthest along the normal.
struct BoxPlane {
  Vec3f normal;
  float offset_m;
  std::array<int, 3> farthest;  ///< which of TreeNode::bounds, by axis
  BoxPlane() = default;
  BoxPlane(const Vec3f& n, const Vec3f& origin) : normal(n), offset_m(n.dot(origin)) {
    for (int i = 0; i < 3; ++i) farthest[static_cast<size_t>(i)] = n[i] > 0 ? 1 : 0;
  }
  /// How far the boxes reach along the normal, from the origin on.
  Floats reach_m(const TreeNode& node) const {
    return normal.x() * load(node.bounds[farthest[0]][0]) + normal.y() * load(node.bounds[farthest[1]][1]) +
           normal.z() * load(node.bounds[farthest[2]][2]) - offset_m;
  }
  float reach_m(const Vec3f& low, const Vec3f& high) const {
    float sum = -offset_m;
    for (int i = 0; i < 3; ++i) sum += normal[i] * (farthest[static_cast<size_t>(i)] ? high[i] : low[i]);
    return sum;
  }
};

/// A leaf as the beam's origin sees it.
struct EightTriangles {
  Vectors sides[3];      ///< s B x C, s C x A, s A x B
  Vectors plane;         ///< (B - A) x (C - A) / A.((B - A) x (C - A))
  unsigned seen = 0;     ///< bits of those that are not wholly beside the beam
  unsigned filling = 0;  ///< and of those that hold all of it

  EightTriangles(const TreeLeaf& leaf, const Beam& beam) {
    const Vectors origin{all(beam.origin.x()), all(beam.origin.y()), all(beam.origin.z())};
    const auto corner = [&](int k) {
      return Vectors{load(leaf.corners[k][0]), load(leaf.corners[k][1]), load(leaf.corners[k][2])};
    };
    const Vectors a = corner(0) - origin, b = corner(1) - origin, c = corner(2) - origin;
    // From the edges, which are short: far away, a.(b x c) would be the difference of large numbers.
    const Vectors normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const Floats volume = a.dot(normal), share = 1.0f / volume;
    plane = {normal.x * share, normal.y * share, normal.z * share};
    const Ints sign = (Ints)volume & static_cast<int32_t>(0x80000000u);
    sides[0] = b.cross(c).signed_by(sign);
    sides[1] = c.cross(a).signed_by(sign);
    sides[2] = a.cross(b).signed_by(sign);
    classify(beam, volume);
  }

  /// Of one triangle.
  struct Numbers {
    float sides[3][3], plane[3];
  };
  Numbers of(int i) const {
    const auto lane = [i](const Vectors& v, float(&to)[3]) {
      to[0] = v.x[i], to[1] = v.y[i], to[2] = v.z[i];
    };
    Numbers one;
    for (int k = 0; k < 3; ++k) lane(sides[k], one.sides[k]);
    lane(plane, one.plane);
    return one;
  }

 private:
  /// A triangle lies beside the beam if all four corners of it lie beside the same side.
  void classify(const Beam& beam, Floats volume) {
    Floats least = all(std::numeric_limits<float>::max()), least_of_most = least;
    for (const Vectors& side : sides) {
      Floats low = side.dot(beam.corners[0]), high = low;
      for (size_t i = 1; i < 4; ++i) {
        const Floats at = side.dot(beam.corners[i]);
        low = min(low, at), high = max(high, at);
      }
      least = min(least, low), least_of_most = min(least_of_most, high);
    }
    seen = mask((least_of_most >= 0) & (volume != 0));
    filling = mask(least >= 0);
  }
  static unsigned mask(Ints on) { return static_cast<unsigned>(_mm256_movemask_ps((__m256)on)); }
};

class BeamTrace {
 public:
  BeamTrace(const TriangleTree& tree, const Beam& beam, std::span<const MovedTriangles> moved, float near_m,
            BeamHits& hits)
      : tree_(tree), beam_(beam), moved_(moved), most_inverse_(1 / near_m), hits_(hits) {
    for (size_t i = 0; i < 4; ++i) {
      // Inwards.
      Vec3f n = beam.corners[i].cross(beam.corners[(i + 1) % 4]);
      if (n.dot(beam.axis) < 0) n = -n;
      sides_[i] = BoxPlane(n.normalized(), beam.origin);
    }
    behind_ = BoxPlane(-beam.axis, beam.origin);
    for (int v = 0; v < Beam::kRays; v += kLanes) {
      store(hits.inverse_range + v, all(1 / kFarthest_m));
      store(reinterpret_cast<float*>(hits.triangle + v), (Floats)(Ints{} - 1));
    }
  }

  bool run() {
    for (const MovedTriangles& m : moved_)
      if (meets(m)) return false;
    push(0, 0);
    int visits = 0;
    while (waiting_ > 0) {
      const Visit visit = stack_[--waiting_];
      if (visit.near_m >= far_m_) continue;
      if (++visits > kMostVisits) return false;
      if (!(visit.child < 0 ? visit_leaf(tree_.leaves[static_cast<size_t>(~visit.child)])
                            : visit_node(tree_.nodes[static_cast<size_t>(visit.child)])))
        return false;
    }
    return true;
  }

 private:
  struct Visit {
    float near_m;
    int32_t child;
  };
  static constexpr int kMostWaiting = 256;

  bool meets(const MovedTriangles& m) const {
    return m.present && std::all_of(sides_.begin(), sides_.end(), [&](const BoxPlane& side) {
             return side.reach_m(m.low_world, m.high_world) >= 0;
           });
  }

  /// Keeps the nearest visit on top.
  void push(float near_m, int32_t child) {
    int at = waiting_++;
    for (; at > bottom_ && stack_[at - 1].near_m < near_m; --at) stack_[at] = stack_[at - 1];
    stack_[at] = {near_m, child};
  }

  bool visit_node(const TreeNode& node) {
    Floats reach = sides_[0].reach_m(node);
    for (size_t i = 1; i < 4; ++i) reach = min(reach, sides_[i].reach_m(node));
    alignas(32) float near_m[kLanes];
    const Floats near = -behind_.reach_m(node);
    store(near_m, near);
    const Ints met = (reach >= 0) & (near < far_m_);
    if (waiting_ + kLanes > kMostWaiting) return false;
    bottom_ = waiting_;
    for (auto bits = static_cast<unsigned>(_mm256_movemask_ps((__m256)met)); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      push(near_m[i], node.child[i]);
    }
    return true;
  }

  bool visit_leaf(const TreeLeaf& leaf) {
    const EightTriangles eight(leaf, beam_);
    if (eight.seen == 0) return true;
    for (unsigned bits = eight.seen; bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      if (has_moved(leaf.triangle[i])) continue;
      if (eight.filling >> i & 1) {
        fill(leaf.triangle[i], eight.of(i));
      } else {
        if (++tests_ > kMostTests) return false;
        test(leaf.triangle[i], eight.of(i));
      }
    }
    Floats least = load(hits_.inverse_range);
    for (int v = kLanes; v < Beam::kRays; v += kLanes) least = min(least, load(hits_.inverse_range + v));
    alignas(32) float inverse[kLanes];
    store(inverse, least);
    // The axis is a unit vector: nothing is farther along it than along the ray.
    far_m_ = 1 / *std::min_element(inverse, inverse + kLanes);
    return true;
  }

  bool has_moved(uint32_t triangle) const {
    return std::any_of(moved_.begin(), moved_.end(),
                       [&](const MovedTriangles& m) { return triangle >= m.first && triangle < m.end; });
  }

  void keep_nearer(int v, Floats inverse, Ints hit, uint32_t triangle) {
    const Floats before = load(hits_.inverse_range + v);
    const Ints nearer = hit & (inverse > before) & (inverse < most_inverse_);
    store(hits_.inverse_range + v, nearer ? inverse : before);
    auto* const ids = reinterpret_cast<int32_t*>(hits_.triangle + v);
    const Ints chosen = nearer ? Ints{} + static_cast<int32_t>(triangle) : load(ids);
    store(reinterpret_cast<float*>(ids), (Floats)chosen);
  }

  void fill(uint32_t triangle, const EightTriangles::Numbers& of) {
    for (int v = 0; v < Beam::kRays; v += kLanes) keep_nearer(v, along(of.plane, v), Ints{} - 1, triangle);
  }

  void test(uint32_t triangle, const EightTriangles::Numbers& of) {
    for (int v = 0; v < Beam::kRays; v += kLanes) {
      const Floats inside = min(min(along(of.sides[0], v), along(of.sides[1], v)), along(of.sides[2], v));
      keep_nearer(v, along(of.plane, v), inside >= 0, triangle);
    }
  }

  Floats along(const float (&n)[3], int v) const {
    return n[0] * load(beam_.x + v) + n[1] * load(beam_.y + v) + n[2] * load(beam_.z + v);
  }

  const TriangleTree& tree_;
  const Beam& beam_;
  std::span<const MovedTriangles> moved_;
  float most_inverse_;
  BeamHits& hits_;
  std::array<BoxPlane, 4> sides_;
  BoxPlane behind_;
  float far_m_ = kFarthest_m;  ///< nothing farther than this can be seen
  int tests_ = 0;
  int waiting_ = 0, bottom_ = 0;
  Visit stack_[kMostWaiting];
};

}  // namespace

Beam beam_of(const RayTile& tile, const Vec3f& origin, const Eigen::Matrix3f& R) {
  Beam beam;
  beam.origin = origin;
  for (int v = 0; v < Beam::kRays; v += kLanes) {
    const Floats x = load(tile.x + v), y = load(tile.y + v), z = load(tile.z + v);
    store(beam.x + v, R(0, 0) * x + R(0, 1) * y + R(0, 2) * z);
    store(beam.y + v, R(1, 0) * x + R(1, 1) * y + R(1, 2) * z);
    store(beam.z + v, R(2, 0) * x + R(2, 1) * y + R(2, 2) * z);
  }
  beam.corners = {R * Vec3f(tile.low_x, tile.low_y, 1), R * Vec3f(tile.high_x, tile.low_y, 1),
                  R * Vec3f(tile.high_x, tile.high_y, 1), R * Vec3f(tile.low_x, tile.high_y, 1)};
  beam.axis = (beam.corners[0] + beam.corners[2]).normalized();
  return beam;
}

bool trace(const TriangleTree& tree, const Beam& beam, std::span<const MovedTriangles> moved, float near_m,
           BeamHits& hits) {
  return BeamTrace(tree, beam, moved, near_m, hits).run();
}

}  // namespace vsslam

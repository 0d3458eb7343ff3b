#include "worlds/outdoor/tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rng.h"

namespace vsslam {

namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

/// A point of the unit sphere.
Vec3 direction(const RandomStream& draws, uint64_t i, uint64_t item) {
  const double z = 2 * draws.uniform(i, item) - 1, azimuth = kTurn_rad * draws.uniform(i, item + 1);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

/// A triangle of any attitude about `centre`; its texture is a patch of leaves.
void add_leaves(MeshBuilder& builder, int material, const Vec3& centre, double size_m,
                const RandomStream& draws, uint64_t i) {
  const Vec3 normal = direction(draws, i, 10);
  const Vec3 right = (std::abs(normal.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).cross(normal).normalized();
  const double spin = kTurn_rad * draws.uniform(i, 12), s = size_m * (0.7 + 0.6 * draws.uniform(i, 13));
  const Vec3 x = std::cos(spin) * right + std::sin(spin) * normal.cross(right), y = normal.cross(x);
  const Vec2f corner(static_cast<float>(draws.uniform(i, 14)), static_cast<float>(draws.uniform(i, 15)));
  const auto vertex = [&](double a, double b) {
    return Vertex{(centre + s * (a * x + b * y)).cast<float>(), normal.cast<float>(),
                  corner + Vec2f(static_cast<float>(s * a), static_cast<float>(-s * b))};
  };
  builder.triangle(material, vertex(-0.5, -0.35), vertex(0.5, -0.35), vertex(0, 0.6));
}

Vec3 crown_centre(const Tree& tree) {
  return {0, 0, tree.height_m - 1.2 * tree.crown_radius_m};
}

/// Where branches end and leaves gather: `index` of `kTufts`, in the outer part of an ellipsoid.
constexpr int kTufts = 48;
Vec3 tuft(const Tree& tree, int index) {
  const RandomStream draws(tree.look, "tuft");
  const auto i = static_cast<uint64_t>(index);
  const double r = tree.crown_radius_m * (0.45 + 0.5 * std::cbrt(draws.uniform(i, 4)));
  return crown_centre(tree) + r * direction(draws, i, 0).cwiseProduct(Vec3(1, 1, 1.2));
}

}  // namespace

Mesh make_wood(const OutdoorPalette& palette, const Tree& tree) {
  MeshBuilder builder;
  const RandomStream draws(tree.look, "wood");
  const int kPieces = 4;
  const double fork_m = crown_centre(tree).z() + 0.2 * tree.crown_radius_m;
  Vec3 at(0, 0, -0.1);
  const auto radius = [&](double z) { return tree.trunk_radius_m * (1 - 0.65 * std::max(0.0, z) / fork_m); };
  std::vector<Vec3> forks;
  for (int i = 1; i <= kPieces; ++i) {
    const auto k = static_cast<uint64_t>(i);
    const double lean = 0.06 * tree.height_m / kPieces;
    const Vec3 next(at.x() + lean * (2 * draws.uniform(k, 0) - 1),
                    at.y() + lean * (2 * draws.uniform(k, 1) - 1), fork_m * i / kPieces);
    builder.limb(palette.bark, at, next, radius(at.z()), radius(next.z()), 8, false);
    at = next;
    if (i >= kPieces - 1) forks.push_back(at);
  }
  for (int i = 0; i < kTufts; i += 4) {  // a limb to every fourth tuft, a twig from its middle to the next
    const Vec3 from = forks[static_cast<size_t>(i) % forks.size()], to = tuft(tree, i);
    const Vec3 middle = 0.5 * (from + to) + Vec3(0, 0, 0.15 * (to - from).norm());
    const double r = 0.4 * tree.trunk_radius_m;
    builder.limb(palette.bark, from, middle, r, 0.6 * r, 4, false);
    builder.limb(palette.bark, middle, to, 0.6 * r, 0.2 * r, 3, false);
    builder.limb(palette.bark, middle, tuft(tree, i + 1), 0.4 * r, 0.15 * r, 3, false);
  }
  return builder.finish("wood");
}

Mesh make_foliage(const OutdoorPalette& palette, const Tree& tree) {
  MeshBuilder builder;
  const RandomStream draws(tree.look, "foliage");
  const int material = palette.foliage[static_cast<size_t>(tree.foliage) % palette.foliage.size()];
  for (int k = 0; k < tree.leaf_clusters; ++k) {
    const auto i = static_cast<uint64_t>(k);
    const double r = 0.28 * tree.crown_radius_m * std::sqrt(draws.uniform(i, 4) + 0.15);
    add_leaves(builder, material, tuft(tree, k % kTufts) + r * direction(draws, i, 0), tree.cluster_m, draws,
               i);
  }
  return builder.finish("foliage");
}

Mesh make_hedge(const OutdoorPalette& palette, uint64_t look) {
  constexpr double kLength_m = 2, kHeight_m = 1, kThick_m = 0.5;
  MeshBuilder builder;
  builder.box(palette.hedge, Vec3::Zero(), {kThick_m - 0.1, kLength_m, kHeight_m - 0.08});
  const RandomStream draws(look, "hedge");
  for (uint64_t i = 0; i < 180; ++i) {
    const double side = draws.uniform(i, 0), y = kLength_m * (draws.uniform(i, 1) - 0.5),
                 v = draws.uniform(i, 2);
    const Vec3 on_top(kThick_m * (v - 0.5), y, kHeight_m - 0.04);
    const Vec3 on_side((side < 0.7 ? 0.5 : -0.5) * kThick_m, y, kHeight_m * v);
    add_leaves(builder, palette.hedge, side < 0.3 ? on_top : on_side, 0.17, draws, i);
  }
  return builder.finish("hedge");
}

}  // namespace vsslam

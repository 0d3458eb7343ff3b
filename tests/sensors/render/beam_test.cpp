#include "sensors/render/beam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/rng.h"
#include "sensors/ray/raycaster.h"
#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

constexpr float kNear_m = 0.02f;

/// 32 x 24 pixels, that is 12 tiles; forward is the third axis.
ViewRays narrow_view(double focal_px) {
  std::vector<Vec3f> directions;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      directions.push_back(Vec3((x - 15.5) / focal_px, (y - 11.5) / focal_px, 1).normalized().cast<float>());
  return {32, 24, std::move(directions), static_cast<float>(1 / focal_px)};
}

Eigen::Matrix3f turned(const Vec3& rpy) {
  return SE3::from_rpy(rpy, Vec3::Zero()).matrix3().cast<float>();
}

/// What one ray of a beam hits according to Embree; false: nothing.
bool hit_singly(const Raycaster& raycaster, const Beam& beam, int ray, Raycaster::Hit& hit) {
  const Vec3 direction = Vec3f(beam.x[ray], beam.y[ray], beam.z[ray]).cast<double>();
  return raycaster.trace_one(beam.origin.cast<double>(), direction, 1e5, hit);
}

/// A wall at z = 5 that faces the origin, of `side` x `side` squares.
World tiled_wall(int side, double size_m = 20) {
  World world;
  world.materials = {shapes::paint(0.5f)};
  Primitive all;
  const double cell_m = size_m / side;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i)
      all.positions.push_back(Vec3(i * cell_m - size_m / 2, size_m / 2 - j * cell_m, 5).cast<float>());
  all.normals.assign(all.positions.size(), -Vec3f::UnitZ());
  const auto at = [&](int i, int j) { return static_cast<uint32_t>(j * (side + 1) + i); };
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      all.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      all.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  shapes::add(world, std::move(all), "wall", 0);
  return world;
}

TEST(Beam, AWallIsFiveMetresAway) {
  const World world = tiled_wall(1);
  const TriangleTree tree{PlacedTriangles(world)};
  for (const RayTile& tile : narrow_view(40).tiles) {
    const Beam beam = beam_of(tile, Vec3f::Zero(), Eigen::Matrix3f::Identity());
    BeamHits hits;
    ASSERT_TRUE(trace(tree, beam, {}, kNear_m, hits));
    for (int i = 0; i < Beam::kRays; ++i) {
      EXPECT_NEAR(1 / hits.inverse_range[i], 5 / tile.z[i], 2e-6);
      EXPECT_LT(hits.triangle[i], 2u);
    }
  }
}

TEST(Beam, WhatIsTooNearOrBehindOrAsideIsNotHit) {
  const World world = tiled_wall(1, 2);
  const TriangleTree tree{PlacedTriangles(world)};
  const RayTile tile = narrow_view(400).tiles[5];
  const auto hit = [&](const Vec3f& origin, const Vec3& rpy) {
    BeamHits hits;
    EXPECT_TRUE(trace(tree, beam_of(tile, origin, turned(rpy)), {}, kNear_m, hits));
    return hits.triangle[20] != BeamHits::kNone;
  };
  EXPECT_TRUE(hit({0, 0, 0}, Vec3::Zero()));
  EXPECT_TRUE(hit({0, 0, 10}, {M_PI, 0, 0}));  // its back
  EXPECT_FALSE(hit({0, 0, 0}, {M_PI, 0, 0}));
  EXPECT_FALSE(hit({0, 0, 4.985f}, Vec3::Zero()));
  EXPECT_FALSE(hit({3, 0, 0}, Vec3::Zero()));
}

TEST(Beam, NoRaySlipsBetweenTriangles) {
  const World world = tiled_wall(200);
  const TriangleTree tree{PlacedTriangles(world)};
  const ViewRays view = narrow_view(1000);
  for (const double roll : {0.0, 0.3, M_PI / 4, 1.2})
    for (const RayTile& tile : view.tiles) {
      const Beam beam = beam_of(tile, {0.05f, -0.15f, 0}, turned({0.4, -0.3, roll}));
      BeamHits hits;
      ASSERT_TRUE(trace(tree, beam, {}, kNear_m, hits));
      for (int i = 0; i < Beam::kRays; ++i) EXPECT_NEAR(1 / hits.inverse_range[i], 5 / beam.z[i], 1e-5);
    }
}

/// A room full of triangles of all sizes, some of which cross each other and the camera's plane.
World crowded_room() {
  World world = shapes::room_world({-4, -3, -2}, {4, 3, 2});
  const RandomStream draw(1, "crowd");
  Primitive crowd;
  for (uint64_t t = 0; t < 150; ++t) {
    const Vec3 middle(7 * draw.uniform(t, 0) - 3.5, 5 * draw.uniform(t, 1) - 2.5,
                      3 * draw.uniform(t, 2) - 1.5);
    const double size_m = 1.2 * std::pow(draw.uniform(t, 3), 2);
    for (uint64_t corner = 0; corner < 3; ++corner) {
      const Vec3 offset(draw.normal(t, 4 + 3 * corner), draw.normal(t, 5 + 3 * corner),
                        draw.normal(t, 6 + 3 * corner));
      crowd.triangles.resize(t + 1);
      crowd.triangles[t][corner] = static_cast<uint32_t>(crowd.positions.size());
      crowd.positions.push_back((middle + size_m * offset).cast<float>());
      crowd.normals.push_back(Vec3f::UnitZ());
    }
  }
  shapes::add(world, std::move(crowd), "crowd", 0);
  return world;
}

TEST(Beam, HitsWhatItsRaysHitOneByOne) {
  const World world = crowded_room();
  const Raycaster raycaster(world);
  const PlacedTriangles triangles(world);
  const TriangleTree tree(triangles);
  const ViewRays view = narrow_view(60);
  const RandomStream draw(2, "poses");
  size_t rays = 0, elsewhere = 0;
  for (uint64_t k = 0; k < 40; ++k) {
    const Vec3 from(6 * draw.uniform(k, 0) - 3, 4 * draw.uniform(k, 1) - 2, 2 * draw.uniform(k, 2) - 1);
    const Eigen::Matrix3f R =
        turned({6 * draw.uniform(k, 3), 6 * draw.uniform(k, 4), 6 * draw.uniform(k, 5)});
    for (const RayTile& tile : view.tiles) {
      const Beam beam = beam_of(tile, from.cast<float>(), R);
      BeamHits hits;
      if (!trace(tree, beam, {}, kNear_m, hits)) continue;
      for (int i = 0; i < Beam::kRays; ++i, ++rays) {
        Raycaster::Hit hit;
        ASSERT_TRUE(hit_singly(raycaster, beam, i, hit));
        if (hit.range_m < 1.1 * kNear_m) continue;
        // At an edge, rounding decides.
        if (hits.triangle[i] != triangles.index(hit.object, hit.triangle))
          ++elsewhere;
        else
          EXPECT_NEAR(1 / hits.inverse_range[i], hit.range_m, 1e-5 * (1 + hit.range_m));
      }
    }
  }
  EXPECT_GT(rays, 20'000u);  // of 30 720
  EXPECT_LT(elsewhere, rays / 5000);
}

TEST(Beam, GivesUpWhereTrianglesAreSmallerThanPixels) {
  const World world = tiled_wall(300);
  const TriangleTree tree{PlacedTriangles(world)};
  BeamHits hits;
  const RayTile tile = narrow_view(16).tiles[5];
  EXPECT_FALSE(trace(tree, beam_of(tile, Vec3f::Zero(), Eigen::Matrix3f::Identity()), {}, kNear_m, hits));
}

TEST(Beam, WhatHasMovedIsLeftToRays) {
  World world = tiled_wall(1);
  shapes::add(world, shapes::wall({0, 0, 3}, -Vec3::UnitZ(), 1), "board", 0);
  const PlacedTriangles triangles(world);
  const TriangleTree tree(triangles);
  const Beam beam = beam_of(narrow_view(400).tiles[5], Vec3f::Zero(), Eigen::Matrix3f::Identity());
  BeamHits hits;
  ASSERT_TRUE(trace(tree, beam, {}, kNear_m, hits));
  EXPECT_EQ(hits.triangle[0] / 2, 1u);
  MovedTriangles board{.first = 2, .end = 4, .low_world = {2, -0.5f, 2.9f}, .high_world = {3, 0.5f, 3.1f}};
  ASSERT_TRUE(trace(tree, beam, {&board, 1}, kNear_m, hits));
  EXPECT_EQ(hits.triangle[0] / 2, 0u);
  board.low_world.x() = -0.5f;  // within sight again
  EXPECT_FALSE(trace(tree, beam, {&board, 1}, kNear_m, hits));
  board.present = false;
  EXPECT_TRUE(trace(tree, beam, {&board, 1}, kNear_m, hits));
  EXPECT_EQ(hits.triangle[0] / 2, 0u);
}

TEST(TriangleTree, HoldsEveryTriangleOnceWithinItsBox) {
  const World world = crowded_room();
  const PlacedTriangles triangles(world);
  const TriangleTree tree(triangles);
  std::multiset<uint32_t> found;
  for (const TreeNode& node : tree.nodes)
    for (size_t c = 0; c < 8; ++c) {
      if (node.bounds[0][0][c] > node.bounds[1][0][c] || node.child[c] >= 0) continue;
      const TreeLeaf& leaf = tree.leaves[static_cast<size_t>(~node.child[c])];
      for (size_t i = 0; i < 8; ++i) {
        if (leaf.corners[0][0][i] == 0 && leaf.corners[1][0][i] == 0 && leaf.corners[2][0][i] == 0) continue;
        found.insert(leaf.triangle[i]);
        for (size_t k = 0; k < 3; ++k)
          for (size_t axis = 0; axis < 3; ++axis) {
            EXPECT_GT(leaf.corners[k][axis][i], node.bounds[0][axis][c]);
            EXPECT_LT(leaf.corners[k][axis][i], node.bounds[1][axis][c]);
          }
      }
    }
  EXPECT_EQ(found.size(), triangles.all.size());
  EXPECT_EQ(std::set<uint32_t>(found.begin(), found.end()).size(), triangles.all.size());
}

TEST(TriangleTree, OfNothingIsEmpty) {
  World world;
  world.materials = {shapes::paint(0.5f)};
  const TriangleTree tree{PlacedTriangles(world)};
  BeamHits hits;
  ASSERT_TRUE(trace(tree, beam_of(narrow_view(40).tiles[0], Vec3f::Zero(), Eigen::Matrix3f::Identity()), {},
                    kNear_m, hits));
  for (const uint32_t triangle : hits.triangle) EXPECT_EQ(triangle, BeamHits::kNone);
}

}  // namespace
}  // namespace vsslam

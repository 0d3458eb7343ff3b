#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/ordered_parallel.h"
#include "core/rng.h"
#include "scenarios/oracles/aliases.h"
#include "scenarios/oracles/loop_truth.h"

namespace vsslam {
namespace {

/// Two rooms of 10 x 10 x 3 m side by side along x, with a wall between them that has no door. The first is about
/// x = 0. Material 1 is glass.
World two_rooms(int dividing_material, float wall_m) {
  World world;
  world.materials.resize(2);
  world.materials[1].glass = true;
  Mesh mesh;
  mesh.primitives.resize(2);
  mesh.primitives[1].material = dividing_material;
  const auto quad = [](Primitive& primitive, Vec3f corner, Vec3f u, Vec3f v) {
    const auto first = static_cast<uint32_t>(primitive.positions.size());
    for (const Vec3f& p : {corner, Vec3f(corner + u), Vec3f(corner + u + v), Vec3f(corner + v)}) {
      primitive.positions.push_back(p);
      primitive.normals.push_back(u.cross(v).normalized());
    }
    primitive.triangles.push_back({first, first + 1, first + 2});
    primitive.triangles.push_back({first, first + 2, first + 3});
  };
  Primitive& shell = mesh.primitives[0];
  quad(shell, {-5, -5, 0}, {20 + wall_m, 0, 0}, {0, 10, 0});
  quad(shell, {-5, -5, 3}, {20 + wall_m, 0, 0}, {0, 10, 0});
  quad(shell, {-5, -5, 0}, {20 + wall_m, 0, 0}, {0, 0, 3});
  quad(shell, {-5, 5, 0}, {20 + wall_m, 0, 0}, {0, 0, 3});
  quad(shell, {-5, -5, 0}, {0, 10, 0}, {0, 0, 3});
  quad(shell, {15 + wall_m, -5, 0}, {0, 10, 0}, {0, 0, 3});
  quad(mesh.primitives[1], {5, -5, 0}, {0, 10, 0}, {0, 0, 3});
  quad(mesh.primitives[1], {5 + wall_m, -5, 0}, {0, 10, 0}, {0, 0, 3});
  world.meshes.push_back(mesh);
  world.objects.emplace_back().name = "rooms";
  return world;
}

/// What a scan at this place sees: 480 rays spread over the sphere, through glass.
KeyScanTruth scan_at(const World& world, const Raycaster& raycaster, int key, double time_s,
                     const SE3& T_world_base) {
  const SE3 T_base_lidar(Quat::Identity(), {0.1, 0, 0.5});
  KeyScanTruth truth{.key = key,
                     .stamp = Time::from_seconds(time_s),
                     .T_world_base = T_world_base,
                     .T_world_lidar = T_world_base * T_base_lidar,
                     .points_lidar = {}};
  for (int i = 0; i < 480; ++i) {
    const double z = (i + 0.5) / 240 - 1, turn = 2.399963 * i, r = std::sqrt(1 - z * z);
    const Vec3 direction_world =
        truth.T_world_lidar.rotation * Vec3(r * std::cos(turn), r * std::sin(turn), z);
    Vec3 origin_world = truth.T_world_lidar.translation;
    Raycaster::Hit hit;
    while (raycaster.trace_one(origin_world, direction_world, 100, hit)) {
      origin_world += hit.range_m * direction_world;
      if (!world.materials[static_cast<size_t>(hit.material)].glass) break;
      origin_world += 1e-3 * direction_world;
    }
    truth.points_lidar.push_back((truth.T_world_lidar.inverse() * origin_world).cast<float>());
  }
  return truth;
}

SE3 at(double x, double y, double yaw = 0) {
  return SE3::from_rpy({0, 0, yaw}, {x, y, 0.2});
}

struct Scene {
  explicit Scene(int dividing_material = 0, float wall_m = 0)
      : world(two_rooms(dividing_material, wall_m)), raycaster(world) {}
  void add(double time_s, const SE3& T_world_base) {
    keys.push_back(scan_at(world, raycaster, static_cast<int>(keys.size()), time_s, T_world_base));
  }
  LoopOracle oracle(const LoopTruthOptions& options = {}) const { return {world, raycaster, keys, options}; }

  World world;
  Raycaster raycaster;
  std::vector<KeyScanTruth> keys;
};

LoopRecord edge(const Scene& scene, int query, int match, const SE3& error, bool accepted = true) {
  LoopRecord record;
  record.query = query;
  record.match = match;
  record.T_match_query = scene.keys[static_cast<size_t>(match)].T_world_base.inverse() *
                         scene.keys[static_cast<size_t>(query)].T_world_base * error;
  record.accepted = accepted;
  return record;
}

TEST(LoopOracle, AllOfAConvexRoomIsSeenFromAnywhereInIt) {
  Scene scene;
  scene.add(0, at(0, 0));
  scene.add(1, at(3, -3, 1.0));
  EXPECT_EQ(scene.oracle().overlap(0, 0), 1.0);
  EXPECT_GE(scene.oracle().overlap(0, 1), 0.995);
  EXPECT_GE(scene.oracle().overlap(1, 0), 0.995);
}

TEST(LoopOracle, WallsHide) {
  Scene scene;
  scene.add(0, at(0, 0));
  scene.add(1, at(10, 0));
  // Of the other room only the dividing wall itself is reached, and what stands within 0.2 m of it.
  const double share = scene.oracle().overlap(0, 1);
  size_t on_the_wall = 0;
  for (const auto& point : scene.keys[0].points_lidar)
    on_the_wall += (scene.keys[0].T_world_lidar * point.cast<double>()).x() > 4.8;
  EXPECT_NEAR(share, static_cast<double>(on_the_wall) / 480, 0.01);
  EXPECT_LT(share, 0.3);
}

TEST(LoopOracle, GlassDoesNotHide) {
  Scene scene(1);
  scene.add(0, at(0, 0));
  scene.add(1, at(10, 0));
  EXPECT_GE(scene.oracle().overlap(0, 1), 0.99);
}

TEST(LoopOracle, FarPointsAreNotSeen) {
  Scene scene;
  scene.add(0, at(-4, 0));
  scene.add(1, at(4, 0));
  const LoopOracle oracle = scene.oracle({.max_range_m = 6});
  size_t near = 0;
  const Vec3 eye = scene.keys[1].T_world_lidar.translation;
  for (const auto& point : scene.keys[0].points_lidar)
    near += (scene.keys[0].T_world_lidar * point.cast<double>() - eye).norm() <= 6;
  EXPECT_NEAR(oracle.overlap(0, 1), static_cast<double>(near) / 480, 0.01);
}

TEST(LoopOracle, RevisitsAreNearOldAndInView) {
  Scene scene;
  scene.add(0, at(0, 0));
  scene.add(20, at(1, 0));     // too recent
  scene.add(31, at(2, 0));     // sees 0 again, 2 m away
  scene.add(40, at(4.2, 0));   // 4.2 m from key scan 0, and key scan 1 is only 20 s old
  scene.add(61, at(6, 0));     // within 4 m of 2, but behind the wall
  scene.add(75, at(1, 1, 3));  // nearest of several: 1
  const auto revisits = scene.oracle().revisits();
  ASSERT_EQ(revisits.size(), 2u);
  EXPECT_EQ(revisits[0].key, 2);
  EXPECT_EQ(revisits[0].of, 0);
  EXPECT_GT(revisits[0].overlap, 0.99);
  EXPECT_EQ(revisits[1].key, 5);
  EXPECT_EQ(revisits[1].of, 1);
}

TEST(LoopOracle, AcceptedEdgesAreTrueWithinHalfAMetreAndFiveDegrees) {
  Scene scene;
  for (int i = 0; i < 4; ++i) scene.add(40 * i, at(0.1 * i, 0, 0.5 * i));
  const double degree = std::numbers::pi / 180;
  const std::vector<LoopRecord> records = {
      edge(scene, 1, 0, SE3()),
      edge(scene, 1, 0, SE3::from_rpy({0, 0, 4.9 * degree}, {0.3, 0, -0.39})),
      edge(scene, 2, 0, SE3::from_rpy({0, 0, 5.1 * degree}, {0, 0, 0})),
      edge(scene, 3, 0, SE3::from_rpy({0, 0, 0}, {0, 0.51, 0})),
      edge(scene, 3, 0, SE3(), false),
  };
  const LoopScore score = scene.oracle().score(records);
  EXPECT_EQ(score.candidates, 5);
  EXPECT_EQ(score.accepted, 4);
  EXPECT_EQ(score.true_loops, 2);
  EXPECT_EQ(score.false_loops, 2);
  EXPECT_EQ(score.precision(), 0.5);
  EXPECT_EQ(verdict_name(score.judgements[1].verdict), "true");
  EXPECT_EQ(verdict_name(score.judgements[2].verdict), "false");
  EXPECT_EQ(verdict_name(score.judgements[4].verdict), "rejected");
  EXPECT_NEAR(*score.judgements[2].error_deg, 5.1, 1e-6);
  EXPECT_NEAR(*score.judgements[3].error_m, 0.51, 1e-6);
}

TEST(LoopOracle, RecallCountsRevisitsNearTrueEdges) {
  Scene scene;
  scene.add(0, at(-4, 0));
  scene.add(1, at(4, 0));
  scene.add(40, at(-4, 0.5));
  scene.add(41, at(4, 0.5));
  const LoopOracle oracle = scene.oracle();
  ASSERT_EQ(oracle.revisits().size(), 2u);
  EXPECT_EQ(oracle.score({}).recall(), 0.0);
  EXPECT_FALSE(oracle.score({}).precision().has_value());
  const SE3 wrong = SE3::from_rpy({0, 0, 0}, {2, 0, 0});
  const std::vector<LoopRecord> records = {edge(scene, 2, 0, SE3()), edge(scene, 3, 1, wrong)};
  const LoopScore score = oracle.score(records);
  EXPECT_EQ(score.recall(), 0.5);
  EXPECT_TRUE(score.revisits[0].closed);
  EXPECT_FALSE(score.revisits[1].closed);
}

TEST(LoopOracle, NothingToRevisitHasNoRecall) {
  Scene scene;
  scene.add(0, at(0, 0));
  EXPECT_FALSE(scene.oracle().score({}).recall().has_value());
  EXPECT_FALSE(LoopOracle(scene.world, scene.raycaster, {}).score({}).recall().has_value());
}

TEST(LoopOracle, DoesNotDependOnTheNumberOfThreads) {
  Scene scene;
  for (int i = 0; i < 60; ++i) scene.add(i, at(4 * std::cos(0.21 * i), 4 * std::sin(0.21 * i), 0.1 * i));
  std::vector<LoopRecord> records;
  for (int i = 31; i < 60; ++i) records.push_back(edge(scene, i, i - 31, SE3()));
  const int before = thread_count();
  set_thread_count(1);
  const LoopScore one = scene.oracle().score(records);
  set_thread_count(2);
  const LoopScore two = scene.oracle().score(records);
  set_thread_count(before);
  ASSERT_EQ(one.revisits.size(), two.revisits.size());
  EXPECT_GT(one.revisits.size(), 20u);
  for (size_t i = 0; i < one.revisits.size(); ++i)
    EXPECT_EQ(one.revisits[i].overlap, two.revisits[i].overlap);
  for (size_t i = 0; i < records.size(); ++i) EXPECT_EQ(one.judgements[i].overlap, two.judgements[i].overlap);
}

/// The descriptor of the rays of scan_at; the LiDAR is 0.7 m above the floor.
ScanContext descriptor(const KeyScanTruth& key) {
  LidarMeasurement measurement;
  for (const auto& point : key.points_lidar) measurement.truth.emplace_back().position_lidar = point;
  ScanContextConfig config;
  config.max_range_m = 20;
  return true_descriptor(measurement, 0.7, config);
}

std::vector<Alias> aliases_of(const Scene& scene, double threshold) {
  std::vector<ScanContext> descriptors;
  for (const KeyScanTruth& key : scene.keys) descriptors.push_back(descriptor(key));
  return find_aliases(scene.oracle(), descriptors, threshold);
}

TEST(Aliases, AreAlikeWithoutSeeingEachOther) {
  for (const int dividing_material : {0, 1}) {
    Scene scene(dividing_material, 0.5f);
    scene.add(0, at(-1, 1.5));
    scene.add(10, at(9.5, 1.5, 1.0));  // the same place of the other room
    scene.add(20, at(-1, 1.4));        // nearly the first place
    const auto aliases = aliases_of(scene, 0.3);
    if (dividing_material == 1) {
      EXPECT_TRUE(aliases.empty()) << "through glass the rooms see each other";
      continue;
    }
    ASSERT_EQ(aliases.size(), 2u);
    EXPECT_EQ(aliases[0].query, 1);
    EXPECT_EQ(aliases[0].match, 0);
    EXPECT_EQ(aliases[1].query, 2);
    EXPECT_EQ(aliases[1].match, 1);
    EXPECT_TRUE(aliases_of(scene, 0.0).empty());
    EXPECT_THROW(find_aliases(scene.oracle(), {}, 0.3), std::logic_error);
  }
}

TEST(KeyScanTruth, TakesPointsEvenlyFromTheWholeScan) {
  LidarMeasurement measurement;
  for (int i = 0; i < 1000; ++i) {
    PointTruth point;
    point.position_lidar = Vec3f(static_cast<float>(i), 0, 0);
    measurement.truth.push_back(point);
  }
  const KeyScanTruth truth = key_scan_truth(3, measurement, at(1, 2), 4);
  EXPECT_EQ(truth.key, 3);
  ASSERT_EQ(truth.points_lidar.size(), 4u);
  EXPECT_EQ(truth.points_lidar[1].x(), 250);
  EXPECT_EQ(truth.points_lidar[3].x(), 750);
  EXPECT_EQ(key_scan_truth(3, measurement, at(1, 2), 5000).points_lidar.size(), 1000u);
}

}  // namespace
}  // namespace vsslam

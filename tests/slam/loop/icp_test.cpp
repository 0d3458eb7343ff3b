#include "slam/loop/icp.h"

#include <gtest/gtest.h>

#include "slam/loop/local_map.h"
#include "tests/slam/loop/loop_room.h"

namespace vsslam {
namespace {

const SE3 kMatch = planar(1, 1, 0.2, 0.6);

/// A local map: what several scans near the match have seen, in its frame.
Cloud target_cloud() {
  Cloud cloud_match;
  for (const SE3& T_match_lidar : {SE3(), planar(-2, 0.5, 0.3), planar(2, -1, 0.1), planar(0, -3, 1)})
    for (const Eigen::Vector3f& p : scan_room(cluttered_room(), kMatch * T_match_lidar))
      cloud_match.push_back((T_match_lidar * p.cast<double>()).cast<float>());
  return voxel_means(cloud_match, 0.15);
}
Cloud source_cloud(const SE3& T_match_query) {
  return voxel_means(scan_room(cluttered_room(), kMatch * T_match_query), 0.3);
}

TEST(Icp, FindsTheMotionBetweenTwoScans) {
  const IcpTarget target(target_cloud());
  const SE3 truth = planar(0.6, -0.4, 0.15);
  const IcpResult result = align(source_cloud(truth), target, SE3(), {}, 0.5);
  EXPECT_TRUE(result.converged);
  EXPECT_LT((result.T_target_source.inverse() * truth).translation.norm(), 0.05);
  EXPECT_LT((result.T_target_source.inverse() * truth).angle(), 0.01);
  EXPECT_LT(result.fitness_m2, 0.02);
  EXPECT_GT(result.overlap, 0.95);
  EXPECT_GE(result.inlier_ratio, result.overlap);
}

TEST(Icp, SamePointsGiveTheMotionToRounding) {
  const Cloud cloud = source_cloud(SE3());
  const SE3 truth = SE3::exp((Vec6() << 0.002, -0.003, 0.004, 0.05, -0.04, 0.02).finished());
  Cloud moved;
  for (const Eigen::Vector3f& p : cloud) moved.push_back((truth.inverse() * p.cast<double>()).cast<float>());
  const IcpResult result = align(moved, IcpTarget(cloud), SE3(), {}, 0.5);
  EXPECT_LT((result.T_target_source.inverse() * truth).log().norm(), 1e-4);
  EXPECT_LT(result.fitness_m2, 1e-8);
  EXPECT_EQ(result.overlap, 1.0);
}

TEST(Icp, ConvergesFromTheYawOfADescriptor) {
  const IcpTarget target(target_cloud());
  const SE3 truth = planar(0.3, 0.2, 100 * M_PI / 180);
  const IcpResult good = align(source_cloud(truth), target, planar(0, 0, 102 * M_PI / 180), {}, 0.5);
  EXPECT_LT((good.T_target_source.inverse() * truth).translation.norm(), 0.05);
  const IcpResult bad = align(source_cloud(truth), target, planar(0, 0, -102 * M_PI / 180), {}, 0.5);
  EXPECT_GT((bad.T_target_source.inverse() * truth).angle(), 0.5);
}

TEST(Icp, FarCloudsDoNotConverge) {
  const IcpTarget target(target_cloud());
  const IcpResult result = align(source_cloud(SE3()), target, planar(500, 0, 0), {}, 0.5);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.fitness_m2, -1);
  EXPECT_EQ(result.inlier_ratio, 0);
}

TEST(Icp, NeighboursAgreeWithASearchOfAll) {
  const IcpTarget target(target_cloud());
  for (const Eigen::Vector3f& p : source_cloud(planar(3, 1, 0.5))) {
    float first = 1e30f, second = 1e30f;
    for (const Eigen::Vector3f& q : target.points()) {
      const float d = (p - q).norm();
      if (d < first) {
        second = first;
        first = d;
      } else {
        second = std::min(second, d);
      }
    }
    const IcpTarget::Neighbours found = target.find(p, 100);
    ASSERT_GE(found.nearest, 0);
    EXPECT_FLOAT_EQ(found.distance_m, first);
    EXPECT_FLOAT_EQ(found.next_distance_m, second);
    if (second - first < 1e-3f) continue;
    const IcpTarget::Neighbours within = target.find(p, 0.5f * (first + second));
    EXPECT_EQ(within.nearest, found.nearest);
    EXPECT_FLOAT_EQ(within.next_distance_m, 0.5f * (first + second));
    EXPECT_EQ(target.find(p, 0.99f * first).nearest, -1);
  }
}

TEST(Icp, SameResultTwice) {
  const Cloud source = source_cloud(planar(0.6, -0.4, 0.15));
  const IcpResult a = align(source, IcpTarget(target_cloud()), SE3(), {}, 0.5);
  const IcpResult b = align(source, IcpTarget(target_cloud()), SE3(), {}, 0.5);
  EXPECT_EQ(a.T_target_source.translation, b.T_target_source.translation);
  EXPECT_EQ(a.T_target_source.rotation.coeffs(), b.T_target_source.rotation.coeffs());
  EXPECT_EQ(a.fitness_m2, b.fitness_m2);
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST(LocalMap, VoxelMeansAreMeans) {
  const Cloud means = voxel_means({{0.1f, 0.1f, 0.1f}, {-0.1f, 0, 0}, {0.3f, 0.1f, 0.1f}}, 0.5);
  ASSERT_EQ(means.size(), 2u);
  EXPECT_TRUE(means[0].isApprox(Eigen::Vector3f(0.2f, 0.1f, 0.1f)));
  EXPECT_TRUE(means[1].isApprox(Eigen::Vector3f(-0.1f, 0, 0)));
}

TEST(LocalMap, KeyScansStandInTheirOwnPosesUntilThePosesChange) {
  std::vector<KeyScan> keys(5);
  for (int id = 0; id < 5; ++id) {
    keys[static_cast<size_t>(id)].id = id;
    keys[static_cast<size_t>(id)].T_map_base = planar(10.0 * id, 0, M_PI / 2);
    keys[static_cast<size_t>(id)].features_lidar = share({{1, 0, 0}});
  }
  LocalMaps maps({.half_width_scans = 1, .voxel_m = 0.1}, SE3(Quat::Identity(), {0, 0, 0.5}));
  const auto map = maps.around(2, 5, keys);
  ASSERT_EQ(map->points().size(), 3u);  // in the base frame of key scan 2, whose x axis is the map's y
  EXPECT_LT((map->points()[0] - Eigen::Vector3f(1, 10, 0.5f)).norm(), 1e-5);
  EXPECT_LT((map->points()[1] - Eigen::Vector3f(1, 0, 0.5f)).norm(), 1e-5);
  EXPECT_LT((map->points()[2] - Eigen::Vector3f(1, -10, 0.5f)).norm(), 1e-5);
  EXPECT_EQ(maps.around(2, 5, keys), map);
  EXPECT_EQ(maps.around(0, 5, keys)->points().size(), 2u);
  EXPECT_EQ(maps.around(2, 3, keys)->points().size(), 2u);  // key scan 3 asks, and is left out
  keys[3].T_map_base = planar(30.5, 0, M_PI / 2);
  const auto moved = maps.around(2, 5, keys);
  EXPECT_NE(moved, map);
  EXPECT_LT((moved->points()[2] - Eigen::Vector3f(1, -10.5f, 0.5f)).norm(), 1e-5);
}

}  // namespace
}  // namespace vsslam

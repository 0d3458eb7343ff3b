#include <gtest/gtest.h>

#include "slam/loop/verify_loop.h"
#include "tests/slam/loop/loop_room.h"

namespace vsslam {
namespace {

SE3 at(double x_m, double y_m) {
  return {Quat::Identity(), {x_m, y_m, 1.0}};
}

// Ten key scans along a corridor, and another one between the fifth and the sixth of them, 0.6 m aside.
std::vector<KeyScan> keys_in(const TestRoom& room, const SE3& T_map_query) {
  std::vector<KeyScan> keys;
  for (int i = 0; i <= 10; ++i) {
    KeyScan key;
    key.id = i;
    key.T_odom_base = key.T_map_base = i < 10 ? at(i, 0) : T_map_query;
    key.features_lidar = share(scan_room(room, key.T_map_base, 300));
    keys.push_back(key);
  }
  return keys;
}

// Errors of the accepted pose: along the corridor and across.
Vec2 verified_errors_m(const TestRoom& room, double prediction_ratio) {
  const SE3 T_map_query = at(4.4, 0.6);
  const std::vector<KeyScan> keys = keys_in(room, T_map_query);
  VerificationConfig config = VsSlamLoopConfig{}.verification;
  config.prediction_ratio = prediction_ratio;
  config.min_plane_share = 0;
  LocalMaps maps({}, SE3());
  LoopRecord record;
  record.match = 4;
  record.query = 10;
  const SE3 truth = keys[4].T_map_base.inverse() * T_map_query;
  record.T_match_query = truth * SE3(Quat::Identity(), {0.9, 0.2, 0});  // as a virtual descriptor may say
  record.T_match_query_predicted = truth * SE3(Quat::Identity(), {0.05, -0.1, 0});
  verify_loop(keys, SE3(), config, maps, record);
  EXPECT_TRUE(record.accepted) << record.why;
  return (record.T_match_query.translation - truth.translation).head<2>().cwiseAbs();
}

TEST(Verification, OfFitsAlikeTheOneThatNeedsNoDriftIsTaken) {
  const TestRoom smooth{long_corridor().front()};
  const Vec2 first_only = verified_errors_m(smooth, 0), both = verified_errors_m(smooth, 1.25);
  EXPECT_GT(first_only.x(), 0.5);  // a corridor fits a corridor
  EXPECT_LT(both.x(), 0.15);
  EXPECT_LT(both.y(), 0.05);
}

TEST(Verification, WhereTheWallsTellTheFirstFitIsGoodEnough) {
  const Vec2 errors = verified_errors_m(cluttered_room(), 0);
  EXPECT_LT(errors.norm(), 0.1);
  EXPECT_LT(verified_errors_m(cluttered_room(), 1.25).norm(), 0.1);
}

// Walls are seen up to 7 m away, further on the rays graze them.
Cloud nearby(const Cloud& cloud_lidar) {
  Cloud near;
  for (const Eigen::Vector3f& p : cloud_lidar)
    if (p.norm() <= 7) near.push_back(p);
  return near;
}

// Ten key scans from 0 to 9 m, and a query that comes the other way, still 4 m before the last of them: a
// quarter of what it sees lies beyond the map. Errors of the accepted pose along the corridor and across.
Vec2 errors_before_the_end_of_the_map_m(double min_plane_share) {
  const SE3 T_map_query = at(13, 0.3);
  std::vector<KeyScan> keys = keys_in(TestRoom{long_corridor().front()}, T_map_query);
  for (KeyScan& key : keys) key.features_lidar = share(nearby(*key.features_lidar));
  keys[10].way_m = 400;
  VerificationConfig config = VsSlamLoopConfig{}.verification;
  config.min_plane_share = min_plane_share;
  LocalMaps maps({}, SE3());
  LoopRecord record;
  record.match = 9;
  record.query = 10;
  const SE3 truth = keys[9].T_map_base.inverse() * T_map_query;
  record.T_match_query = SE3(Quat::Identity(), {-2.5, 0.2, 0}) * truth;  // as a virtual descriptor may say
  record.T_match_query_predicted = SE3(Quat::Identity(), {0.05, -0.1, 0}) * truth;
  verify_loop(keys, SE3(), config, maps, record);
  EXPECT_TRUE(record.accepted) << record.why;
  EXPECT_EQ(record.planes.has_value(), min_plane_share > 0);
  // Along the corridor; and its height, without a floor.
  EXPECT_EQ(record.planes.value_or(Degeneracy{.directions = 2}).directions, 2);
  return (record.T_match_query.translation - truth.translation).head<2>();
}

TEST(Verification, IsNotDrawnBackToWhereTheMapHasMorePoints) {
  EXPECT_LT(errors_before_the_end_of_the_map_m(0).x(), -3);
  const Vec2 errors = errors_before_the_end_of_the_map_m(0.01);
  EXPECT_NEAR(errors.x(), 0.05, 1e-3);  // what odometry says: no wall contradicts it
  EXPECT_NEAR(errors.y(), 0, 1e-3);
}

}  // namespace
}  // namespace vsslam

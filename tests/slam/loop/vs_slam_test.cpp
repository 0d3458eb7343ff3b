// Virtual descriptors, selective memory, and the methods made of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "slam/loop/selective_memory.h"
#include "slam/loop/virtual_descriptors.h"
#include "tests/slam/loop/loop_laps.h"

namespace vsslam {
namespace {

TEST(VirtualDescriptors, StandAroundTheSensor) {
  const std::vector<Eigen::Vector2d> offsets = virtual_offsets_m({.distances = 2, .spacing_m = 1.5});
  ASSERT_EQ(offsets.size(), 16u);
  std::set<std::pair<int, int>> places;  // in cm
  for (size_t i = 0; i < offsets.size(); ++i) {
    EXPECT_NEAR(offsets[i].norm(), i < 8 ? 1.5 : 3.0, 1e-12);
    places.insert({static_cast<int>(std::lround(100 * offsets[i].x())),
                   static_cast<int>(std::lround(100 * offsets[i].y()))});
  }
  EXPECT_EQ(places.size(), 16u);
  for (const auto& [x, y] : places) EXPECT_TRUE(places.contains({-x, -y}));
  // theta_0 points to +y: the cloud moves there, the sensor away from it.
  EXPECT_NEAR(offsets[0].x(), 0, 1e-12);
  EXPECT_NEAR(offsets[0].y(), -1.5, 1e-12);
  EXPECT_TRUE(virtual_offsets_m({.distances = 0, .spacing_m = 1.5}).empty());
}

// In an empty convex room a scan from aside sees the same walls: only sampling differs.
TEST(VirtualDescriptors, DescribeWhatASensorAsideSees) {
  const TestRoom room{{{-12, -8, 0}, {12, 8, 4}}};
  const SE3 T_map_lidar = planar(2, 1, 0.4, kMountHeight);
  const Cloud here = scan_room(room, T_map_lidar);
  for (const QueryDescriptor& descriptor : describe_query(here, kMountHeight, {}, {})) {
    const SE3 T_lidar_aside(Quat::Identity(), {descriptor.offset_m.x(), descriptor.offset_m.y(), 0});
    const ScanContext aside(polar_heights(scan_room(room, T_map_lidar * T_lidar_aside), kMountHeight, {}));
    const ShiftedDistance distance = scan_context_distance(descriptor.context, aside);
    EXPECT_LT(distance.distance, 0.1) << descriptor.virtual_id;
    EXPECT_EQ(distance.shift, 0) << descriptor.virtual_id;
    if (descriptor.virtual_id > 8) {
      const ScanContext own(polar_heights(here, kMountHeight, {}));
      EXPECT_GT(scan_context_distance(own, aside).distance, distance.distance + 0.03);
    }
  }
}

TEST(VirtualDescriptors, TheFirstIsTheScansOwn) {
  const Cloud cloud = scan_room(cluttered_room(), planar(1, 0, 0, kMountHeight));
  const std::vector<QueryDescriptor> query = describe_query(cloud, kMountHeight, {}, {});
  ASSERT_EQ(query.size(), 17u);
  const ScanContext own(polar_heights(cloud, kMountHeight, {}));
  EXPECT_TRUE((query[0].context.real == own.real).all());
  EXPECT_TRUE((query[0].context.imaginary == own.imaginary).all());
  for (size_t i = 0; i < query.size(); ++i) EXPECT_EQ(query[i].virtual_id, static_cast<int>(i));
}

std::vector<QueryDescriptor> query_at(double x_m, double y_m, int distances = 0) {
  return describe_query(scan_room(cluttered_room(), planar(x_m, y_m, 0, kMountHeight)), kMountHeight, {},
                        {.distances = distances, .spacing_m = 1.5});
}

Information information(double alpha_t, double alpha_r) {
  const double t = 1 - alpha_t, r = 1 - alpha_r;
  return analyse_information(Vec6(100 * r, 90, 100, 100 * t, 95, 100).asDiagonal());
}

TEST(SelectiveMemory, SimilarScenesAreNotDistinct) {
  const auto query = query_at(0, 0);
  const auto distinct = [&](double alpha_t, double alpha_r) {
    return decide({}, information(alpha_t, alpha_r), query, {}).distinct;
  };
  EXPECT_TRUE(distinct(0.5, 0.5));
  EXPECT_TRUE(distinct(0.989, 0.989));
  EXPECT_FALSE(distinct(0.991, 0.5));
  EXPECT_FALSE(distinct(0.5, 0.991));
  EXPECT_FALSE(decide({}, Information{}, query, {}).distinct);  // no information at all
  SelectiveMemoryConfig off;
  off.scene_recognition = false;
  EXPECT_TRUE(decide(off, information(1, 1), query, {}).distinct);
}

TEST(SelectiveMemory, IsNovelIfUnlikeAllThatItMustDifferFrom) {
  const Information clear = information(0.5, 0.5), similar = information(0.999, 0.5);
  const auto near = query_at(0, 0), far = query_at(9, -6);
  ASSERT_GT(scan_context_distance(near[0].context, far[0].context).distance, 0.25);
  const ScanContext *at_near = &near[0].context, *at_far = &far[0].context;
  EXPECT_TRUE(decide({}, clear, near, {}).stored());
  EXPECT_TRUE(decide({}, clear, near, {at_far}).stored());
  EXPECT_FALSE(decide({}, clear, near, {at_far, at_near}).stored());
  EXPECT_TRUE(decide({}, similar, near, {}).novel);
  EXPECT_FALSE(decide({}, similar, near, {}).stored());
  SelectiveMemoryConfig off;
  off.key_descriptors = false;
  EXPECT_TRUE(decide(off, clear, near, {at_near}).stored());
}

TEST(SelectiveMemory, OneSimilarVirtualDescriptorIsEnoughNotToStore) {
  const Information clear = information(0.5, 0.5);
  const auto stored = query_at(0, 0);
  const auto novel = [&](double x_m, int distances) {
    return decide({}, clear, query_at(x_m, 0, distances), {&stored.front().context}).novel;
  };
  double x_m = 0;  // so far aside that the descriptor itself is novel
  while (x_m < 6 && !novel(x_m, 0)) x_m += 0.5;
  ASSERT_LT(x_m, 6);
  EXPECT_FALSE(novel(x_m, 2));
}

int true_loops(const std::vector<LoopRecord>& records, const Drive& drive) {
  int count = 0;
  for (const LoopRecord& record : records) count += record.accepted && error_m(record, drive) < 0.5;
  return count;
}

TEST(VsSlam, FindsPlacesPassedAside) {
  const Drive drive = laps(50, 0.005, -1.5);
  const auto play_as = [&](Method method) {
    LoopConfig config;
    config.vs_slam.max_distance = 0.2;
    config.vs_slam.memory.key_descriptors = false;
    LoopCloser closer(config, method, kLidar, nullptr);
    return play(closer, drive);
  };
  const auto with = play_as(Method::vs_slam), without = play_as(Method::vs_slam_no_vd);
  EXPECT_GT(true_loops(with, drive), true_loops(without, drive) + 5);
  for (const LoopRecord& record : with) {
    EXPECT_EQ(record.virtual_offset_m.norm() > 0, record.virtual_id > 0);
    EXPECT_TRUE(!record.accepted || error_m(record, drive) < 0.5) << record.query;
  }
}

TEST(VsSlam, StoresAFewAndStillClosesLoops) {
  const Drive drive = laps(60, 0.005);
  LoopCloser selecting({}, Method::vs_slam, kLidar, nullptr),
      storing({}, Method::vs_slam_no_st, kLidar, nullptr),
      scan_context({}, Method::sc_lvi_sam, kLidar, nullptr);
  const auto records = play(selecting, drive);
  play(storing, drive);
  play(scan_context, drive);
  EXPECT_EQ(storing.stored().size(), drive.keys.size());
  EXPECT_EQ(scan_context.stored().size(), drive.keys.size());
  EXPECT_LT(selecting.stored().size(), drive.keys.size() / 2);
  EXPECT_GT(true_loops(records, drive), 5);
  ASSERT_TRUE(selecting.decision());
  EXPECT_FALSE(scan_context.decision());
}

TEST(VsSlam, APlacePassedAgainIsNotStoredAgain) {
  const auto stored = [](SelectiveMemoryConfig::NovelTo novel_to, int keys) {
    LoopConfig config;
    config.vs_slam.memory.novel_to = novel_to;
    LoopCloser closer(config, Method::vs_slam, kLidar, nullptr);
    play(closer, laps(keys, 0.005));
    return closer.stored().size();
  };
  using enum SelectiveMemoryConfig::NovelTo;
  EXPECT_GT(stored(last, 25), 2u);
  EXPECT_LE(stored(search, 75), stored(search, 25) + 1);
  EXPECT_GE(stored(last, 75), 2 * stored(last, 25));
}

// Along a corridor all scans are like the first: unless it counts only where a search looks, it is the only one stored,
// and nothing is found further on.
TEST(VsSlam, EveryKeyScanIsLikeOneThatASearchFromThereReaches) {
  const Drive drive = along_corridor(60);
  const auto stored_keys = [&](SelectiveMemoryConfig::NovelTo novel_to) {
    LoopConfig config;
    config.vs_slam.search_reach_m = 6;
    config.vs_slam.memory.novel_to = novel_to;
    LoopCloser closer(config, Method::vs_slam, kLidar, nullptr);
    play(closer, drive);
    std::vector<int> keys;
    for (const StoredDescriptor& descriptor : closer.stored()) keys.push_back(descriptor.key);
    return keys;
  };
  using enum SelectiveMemoryConfig::NovelTo;
  EXPECT_EQ(stored_keys(last).size(), 1u);
  const std::vector<int> keys = stored_keys(search);
  constexpr double kAllowedGap_m = 1 + 0.01 * 60;
  for (const KeyScan& key : drive.keys)
    EXPECT_TRUE(std::any_of(keys.begin(), keys.end(), [&](int stored) {
      return std::abs(stored - key.id) <= 6 + kAllowedGap_m;  // a key scan every metre
    })) << key.id;
}

TEST(VsSlam, StoringAndSearchingNothingIsNoLoopClosing) {
  LoopConfig config;
  config.vs_slam.memory.alpha_t_th = 0;
  LoopCloser closer(config, Method::vs_slam, kLidar, nullptr);
  const Drive drive = laps(60, 0);
  EXPECT_TRUE(play(closer, drive).empty());
  EXPECT_EQ(closer.database_size(drive.keys).count, 0);
}

TEST(VsSlam, LeavesOutTheRecentPast) {
  LoopConfig config;
  config.vs_slam.exclude_recent_s = 60;  // 40 key scans
  LoopCloser closer(config, Method::vs_slam_no_st, kLidar, nullptr);
  const auto records = play(closer, laps(60, 0));
  ASSERT_FALSE(records.empty());
  for (const LoopRecord& record : records) EXPECT_GE(record.query - record.match, 40);
}

TEST(VsSlam, RefusesLoopsThatOdometryRulesOut) {
  Drive drive = laps(60, 0);
  for (size_t i = 35; i < drive.keys.size(); ++i) {  // belief says: another room
    drive.keys[i].T_map_base = planar(40, 0, 0) * drive.keys[i].T_map_base;
  }
  const auto reasons = [&](auto change) {
    LoopConfig config;
    config.vs_slam.search_reach_m = 0;
    change(config.vs_slam.verification);
    LoopCloser closer(config, Method::vs_slam_no_st, kLidar, nullptr);
    return play(closer, drive).back().why;
  };
  EXPECT_EQ(reasons([](VerificationConfig&) {}), "gap");
  EXPECT_EQ(reasons([](VerificationConfig& v) { v.max_gap_m = 45; }), "accepted");
  EXPECT_EQ(reasons([](VerificationConfig& v) { v.max_gap_m = v.max_gap_share = 0; }), "accepted");
}

// The second of three laps is in another room that looks the same; the third is driven as the second was, so what
// it sees is more like the wrong room than like the first lap.
TEST(VsSlam, ALookAlikeOutOfReachDoesNotHideThePlaceItself) {
  Drive drive = laps(75, 0, 0.8);
  for (size_t i = 25; i < 50; ++i)
    for (SE3* T : {&drive.keys[i].T_map_base, &drive.keys[i].T_odom_base, &drive.truth[i]})
      *T = planar(60, 0, 0) * *T;
  const auto loops_of_third_lap = [&](double search_reach_m) {
    LoopConfig config;
    config.vs_slam.exclude_recent_s = 0;
    config.vs_slam.exclude_recent_scans = 10;
    config.vs_slam.search_reach_m = search_reach_m;
    LoopCloser closer(config, Method::vs_slam_no_st, kLidar, nullptr);
    std::vector<LoopRecord> records = play(closer, drive);
    std::erase_if(records, [](const LoopRecord& r) { return r.query < 50; });
    return records;
  };
  const auto all = loops_of_third_lap(0), near = loops_of_third_lap(5);
  EXPECT_GT(true_loops(near, drive), 20);
  EXPECT_LT(true_loops(all, drive), 15);
  for (const LoopRecord& record : near) EXPECT_TRUE(record.match < 25 || record.match >= 50) << record.match;
}

}  // namespace
}  // namespace vsslam

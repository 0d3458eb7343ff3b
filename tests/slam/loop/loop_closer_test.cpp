#include "slam/loop/loop_closer.h"

#include <gtest/gtest.h>

#include <map>

#include "core/errors.h"
#include "slam/loop/local_map.h"
#include "tests/slam/loop/loop_laps.h"

namespace vsslam {
namespace {

TEST(LoopCloser, WithoutLoopsNothingHappens) {
  LoopCloser closer({}, Method::lvi_sam_no_loop, kLidar, nullptr);
  const Drive drive = laps(3, 0);
  EXPECT_TRUE(play(closer, drive).empty());
  EXPECT_TRUE(closer.stored().empty());
  EXPECT_EQ(closer.database_size(drive.keys).database_bytes, 0u);
}

TEST(LoopCloser, NearestOldKeyPoseIsTheCandidateOfLviSam) {
  const Drive drive = laps(60, 0.01);
  LoopCloser closer({}, Method::lvi_sam, kLidar, nullptr);
  const std::vector<LoopRecord> records = play(closer, drive);
  ASSERT_GT(records.size(), 15u);
  for (const LoopRecord& record : records) {
    EXPECT_EQ(record.query % 2, 0);  // every 2 s at a key scan each 1.5 s
    EXPECT_GT(seconds_between(record.match_stamp, record.query_stamp), 30);
    const Vec3 query = drive.keys[static_cast<size_t>(record.query)].T_map_base.translation;
    const double nearest =
        (drive.keys[static_cast<size_t>(record.match)].T_map_base.translation - query).norm();
    for (const KeyScan& key : drive.keys) {
      const bool old = seconds_between(key.stamp, record.query_stamp) > 30;
      EXPECT_TRUE(!old || (key.T_map_base.translation - query).norm() >= nearest);
    }
    EXPECT_EQ(record.descriptor_distance, -1);
    ASSERT_TRUE(record.accepted) << record.why;
    EXPECT_LT(error_m(record, drive), 0.35);  // the local map smears by its own drift
    EXPECT_EQ(record.edge_variance, record.fitness_m2);
    EXPECT_EQ(loop_edge(record, {}).cauchy_scale, 0);
    EXPECT_EQ(loop_edge(record, {}).information, Mat6(Mat6::Identity() / record.fitness_m2));
  }
  EXPECT_TRUE(closer.stored().empty());
  EXPECT_GT(closer.database_size(drive.keys).database_bytes, 0u);
}

TEST(LoopCloser, FarKeyPosesAreNoCandidates) {
  LoopConfig config;
  config.lvi_sam.search_radius_m = 0.3;
  LoopCloser closer(config, Method::lvi_sam, kLidar, nullptr);
  EXPECT_TRUE(play(closer, laps(40, 0.05)).empty());  // drifted apart by more than that
}

TEST(LoopCloser, ScanContextClosesLoopsAgainstTheDirectionOfTravel) {
  const Drive drive = laps(60, 0.0);
  LoopConfig config;
  config.sc_lvi_sam.exclude_recent_scans = 10;
  LoopCloser closer(config, Method::sc_lvi_sam, kLidar, nullptr);
  int against = 0;
  for (const LoopRecord& record : play(closer, drive)) {
    EXPECT_GE(record.query - record.match, 10);
    EXPECT_TRUE(record.runner_up_distance == -1 || record.runner_up_distance >= record.descriptor_distance);
    if (!record.accepted) continue;
    EXPECT_LT(record.descriptor_distance, 0.3);
    if (record.query >= 32 && record.query < 50 && record.match < 25) {
      ++against;
      EXPECT_GT(std::abs(record.yaw_rad), 2.0);
      EXPECT_LT(error_m(record, drive), 0.25) << record.query << ' ' << record.match;
      EXPECT_GT(record.overlap, 0.8);
    }
    EXPECT_EQ(record.edge_variance, 0.5);
    EXPECT_EQ(loop_edge(record, {}).cauchy_scale, 1);
  }
  EXPECT_GT(against, 10);
}

TEST(LoopCloser, ARefinedEdgeWeighsMoreWhereThePlanesSeeIt) {
  LoopRecord record;
  record.edge_variance = 0.5;
  record.planes.emplace().directions = 1;
  record.planes->scaled_eigenvectors.setIdentity();
  record.planes->scaled_eigenvectors.col(0).swap(record.planes->scaled_eigenvectors.col(3));  // unseen: x
  PoseGraphConfig graph;
  graph.loop_rotation_variance_rad2 = 1e-6;
  graph.loop_translation_variance_m2 = 1e-4;
  Vec6 expected;
  expected << 1e6, 1e6, 1e6, 2, 1e4, 1e4;
  EXPECT_TRUE(loop_edge(record, graph).information.isApprox(Mat6(expected.asDiagonal()), 1e-12));
}

TEST(LoopCloser, AsPublishedStartsFromIdentityAndMissesTheTurn) {
  const Drive drive = laps(45, 0.0);
  LoopConfig config;
  config.sc_lvi_sam.verification = ScLviSamLoopConfig::Verification::as_published;
  LoopCloser closer(config, Method::sc_lvi_sam, kLidar, nullptr);
  int turned = 0;
  for (const LoopRecord& record : play(closer, drive))
    if (std::abs(record.yaw_rad) > 2.0) {
      ++turned;
      EXPECT_LT(record.T_match_query.angle(), 2.0);  // ICP does not find a half turn from identity
    }
  EXPECT_GT(turned, 3);
}

TEST(LoopCloser, DissimilarScansAreRecordedButNotVerified) {
  LoopConfig config;
  config.sc_lvi_sam.max_distance = 0.0;
  LoopCloser closer(config, Method::sc_lvi_sam, kLidar, nullptr);
  const Drive drive = laps(40, 0);
  const std::vector<LoopRecord> records = play(closer, drive);
  ASSERT_EQ(records.size(), 10u);  // the first is of key scan 30
  EXPECT_EQ(records.front().query, 30);
  for (const LoopRecord& record : records) {
    EXPECT_EQ(record.why, "distance");
    EXPECT_FALSE(record.icp_run);
  }
}

TEST(LoopCloser, EveryRejectionHasAReason) {
  const Drive drive = laps(40, 0);
  const auto reasons = [&](auto change) {
    LoopConfig config;
    change(config.lvi_sam.verification);
    LoopCloser closer(config, Method::lvi_sam, kLidar, nullptr);
    const std::vector<LoopRecord> records = play(closer, drive);
    EXPECT_FALSE(records.empty());
    for (const LoopRecord& record : records) EXPECT_EQ(record.accepted, record.why == "accepted");
    return records.empty() ? std::string() : records.back().why;
  };
  EXPECT_EQ(reasons([](VerificationConfig&) {}), "accepted");
  EXPECT_EQ(reasons([](VerificationConfig& v) { v.max_fitness_m2 = 1e-9; }), "fitness");
  EXPECT_EQ(reasons([](VerificationConfig& v) { v.min_overlap = 1.0, v.overlap_distance_m = 1e-4; }),
            "overlap");
  EXPECT_EQ(reasons([](VerificationConfig& v) { v.min_source_points = 1000000; }), "few_points");
  EXPECT_EQ(reasons([](VerificationConfig& v) { v.icp.max_correspondence_m = 1e-6; }), "not_converged");
}

TEST(LoopCloser, FarCentroidsAreBroughtTogetherFirst) {
  Drive drive = laps(50, 0);
  drive.keys.back().T_map_base = planar(500, 0, 0) * drive.truth.back();  // belief is far off
  LoopConfig config;
  config.lvi_sam.search_radius_m = 1000;
  config.lvi_sam.verification.icp.max_correspondence_m = 5;
  for (double centroid_guess_m : {0.0, 20.0}) {
    config.lvi_sam.verification.centroid_guess_m = centroid_guess_m;
    LoopCloser closer(config, Method::lvi_sam, kLidar, nullptr);
    const std::vector<LoopRecord> records = closer.add(drive.keys, drive.keys.back().stamp);
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].why == "not_converged", centroid_guess_m == 0);
  }
}

TEST(LoopCloser, SizesFollowTheFormula) {
  LoopCloser closer({}, Method::sc_lvi_sam, kLidar, nullptr);
  std::vector<KeyScan> keys;
  EXPECT_EQ(closer.database_size(keys).index_bytes, 24u);
  // Published pairs of count and index bytes.
  const std::map<int, size_t> published{{5, 56}, {17, 152}, {46, 280}, {200, 1048}, {357, 2072}};
  for (int id = 0; id < 357; ++id) {
    KeyScan key;
    key.id = id;
    key.stamp = Time::from_seconds(id);
    key.features_lidar = share(Cloud(3, Eigen::Vector3f::Zero()));
    key.points_lidar = share({});
    keys.push_back(key);
    closer.add(keys, key.stamp);
    const auto known = published.find(id + 1);
    if (known == published.end()) continue;
    const DatabaseSize size = closer.database_size(keys);
    EXPECT_EQ(size.count, id + 1);
    EXPECT_EQ(size.index_bytes, known->second);
    size_t descriptors = 0;
    for (const StoredDescriptor& stored : closer.stored()) descriptors += stored.bytes;
    EXPECT_EQ(size.descriptor_bytes, descriptors);
    EXPECT_EQ(size.database_bytes, size.index_bytes + descriptors + keys.size() * 3 * 12);
  }
}

TEST(LoopCloser, SameRecordsTwice) {
  const Drive drive = laps(45, 0.01);
  LoopConfig config;
  config.sc_lvi_sam.exclude_recent_scans = 10;
  for (Method method : all_methods()) {
    LoopCloser a(config, method, kLidar, nullptr), b(config, method, kLidar, nullptr);
    const std::vector<LoopRecord> first = play(a, drive), second = play(b, drive);
    ASSERT_EQ(first.size(), second.size());
    for (size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].match, second[i].match);
      EXPECT_EQ(first[i].descriptor_distance, second[i].descriptor_distance);
      EXPECT_EQ(first[i].T_match_query.translation, second[i].T_match_query.translation);
      EXPECT_EQ(first[i].T_match_query.rotation.coeffs(), second[i].T_match_query.rotation.coeffs());
      EXPECT_EQ(first[i].fitness_m2, second[i].fitness_m2);
      EXPECT_EQ(first[i].why, second[i].why);
    }
  }
}

TEST(LoopConfig, MethodsHaveNames) {
  for (Method method : all_methods()) EXPECT_EQ(parse_method(method_name(method)), method);
  try {
    parse_method("sc-lvi-sma");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean sc-lvi-sam"), std::string::npos) << e.what();
  }
}

TEST(LoopConfig, DefaultsAreThePublishedOnes) {
  const LoopConfig config;
  EXPECT_EQ(config.lvi_sam.verification.icp.max_correspondence_m, 40);
  EXPECT_EQ(config.lvi_sam.verification.icp.max_iterations, 100);
  EXPECT_EQ(config.lvi_sam.verification.centroid_guess_m, 20);
  EXPECT_EQ(config.sc_lvi_sam.as_published.icp.max_correspondence_m, 150);
  EXPECT_EQ(config.sc_lvi_sam.repaired.icp.max_correspondence_m, 2);
  LoopConfig loaded;
  load_config_text("sc_lvi_sam: {verification: as_published, repaired: {icp: {max_iterations: 7}}}", "x.yaml",
                   loaded);
  EXPECT_EQ(loaded.sc_lvi_sam.verification, ScLviSamLoopConfig::Verification::as_published);
  EXPECT_EQ(loaded.sc_lvi_sam.repaired.icp.max_iterations, 7);
  EXPECT_EQ(loaded.sc_lvi_sam.repaired.icp.max_correspondence_m, 2);
  EXPECT_EQ(save_config(LoopConfig{loaded}), save_config(loaded));
  EXPECT_THROW(load_config_text("lvi_sam: {min_age: 3}", "x.yaml", loaded), InputError);
}

}  // namespace
}  // namespace vsslam

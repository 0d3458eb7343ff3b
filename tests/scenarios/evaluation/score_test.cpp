#include "scenarios/evaluation/score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/rng.h"
#include "scenarios/evaluation/trajectory_file.h"

namespace vsslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A winding drive: 0.1 m a step, heading along the path.
PoseTrajectory winding(size_t poses) {
  PoseTrajectory trajectory;
  Vec3 position(3, -2, 0.5);
  for (size_t i = 0; i < poses; ++i) {
    const double yaw = 0.8 * std::sin(0.02 * static_cast<double>(i));
    trajectory.push_back(
        {Time{static_cast<int64_t>(i) * 100'000'000},
         SE3::from_rpy({0.01 * std::sin(0.1 * static_cast<double>(i)), 0.02, yaw}, position)});
    position += 0.1 * Vec3(std::cos(yaw), std::sin(yaw), 0.05 * std::sin(0.03 * static_cast<double>(i)));
  }
  return trajectory;
}

/// n poses along x, `step` m apart.
PoseTrajectory straight(size_t n, double step) {
  PoseTrajectory trajectory;
  for (size_t i = 0; i < n; ++i)
    trajectory.push_back({Time{static_cast<int64_t>(i) * 100'000'000},
                          SE3(Quat::Identity(), {step * static_cast<double>(i), 0, 0})});
  return trajectory;
}

PoseTrajectory moved(const SE3& T, double scale, PoseTrajectory trajectory) {
  for (auto& [stamp, pose] : trajectory) pose = T * SE3(pose.rotation, scale * pose.translation);
  return trajectory;
}

TEST(Score, OfTheTruthItselfIsZero) {
  const PoseTrajectory truth = winding(500);
  const TrajectoryScore result = score(truth, truth);
  EXPECT_EQ(result.pairs, 500);
  EXPECT_LT(result.ate_max_m, 1e-9);
  EXPECT_LT(*result.rpe_10m_percent, 1e-9);
  EXPECT_LT(*result.rpe_10m_deg, 1e-5);
  EXPECT_NEAR(result.end_error_m, 0, 1e-12);
  EXPECT_NEAR(result.path_length_m, 49.9, 0.1);
}

TEST(Score, ConstantOffsetCountsWithoutAlignmentOnly) {
  const PoseTrajectory truth = winding(300);
  const PoseTrajectory estimate = moved(SE3(Quat::Identity(), {0.3, -0.4, 0}), 1, truth);
  const TrajectoryScore unaligned = score(estimate, truth, {.alignment = Alignment::none});
  EXPECT_NEAR(unaligned.ate_rmse_m, 0.5, 1e-12);
  EXPECT_NEAR(unaligned.ate_mean_m, 0.5, 1e-12);
  EXPECT_NEAR(unaligned.ate_max_m, 0.5, 1e-12);
  EXPECT_NEAR(unaligned.end_error_m, 0, 1e-12);
  EXPECT_LT(score(estimate, truth).ate_rmse_m, 1e-12);
}

TEST(Score, AlignmentRecoversARigidMotion) {
  const PoseTrajectory truth = winding(300);
  const SE3 T_truth_estimate = SE3::from_rpy({0.3, -0.2, 2.5}, {5, -7, 1});
  const TrajectoryScore result = score(moved(T_truth_estimate.inverse(), 1, truth), truth);
  EXPECT_LT(result.ate_max_m, 1e-9);
  EXPECT_LT((T_truth_estimate.inverse() * result.alignment.T_truth_estimate).log().norm(), 1e-9);
  EXPECT_EQ(result.alignment.scale, 1.0);
  EXPECT_NEAR(result.end_error_m, 0, 1e-9);
}

TEST(Score, ScaleNeedsSim3) {
  const PoseTrajectory truth = winding(300);
  const PoseTrajectory estimate = moved(SE3::from_rpy({0, 0, 1}, {1, 2, 3}), 0.8, truth);
  EXPECT_GT(score(estimate, truth).ate_rmse_m, 0.5);
  const TrajectoryScore result = score(estimate, truth, {.alignment = Alignment::sim3});
  EXPECT_LT(result.ate_max_m, 1e-9);
  EXPECT_NEAR(result.alignment.scale, 1.25, 1e-9);
  EXPECT_LT(*result.rpe_10m_percent, 1e-7);
}

TEST(Score, SignsOfOneMetreOnTwoPosesGiveTheirRms) {
  PoseTrajectory truth = straight(4, 1);
  PoseTrajectory estimate = truth;
  estimate[1].pose.translation.y() += 3;
  estimate[2].pose.translation.z() -= 4;
  const TrajectoryScore result = score(estimate, truth, {.alignment = Alignment::none});
  EXPECT_NEAR(result.ate_rmse_m, 2.5, 1e-12);  // sqrt((9 + 16) / 4)
  EXPECT_NEAR(result.ate_mean_m, 1.75, 1e-12);
  EXPECT_NEAR(result.ate_max_m, 4, 1e-12);
  EXPECT_THAT(result.errors_m, testing::ElementsAre(0, 3, 4, 0));
}

TEST(Score, DriftOfOnePercentIsOnePercent) {
  const PoseTrajectory truth = straight(1001, 0.1);
  PoseTrajectory estimate = truth;
  for (auto& [stamp, pose] : estimate) pose.translation *= 1.01;
  const ScoreOptions by_truth{.rpe_pairs_from_truth = true};
  const TrajectoryScore result = score(estimate, truth, by_truth);
  // Steps of 0.1 m reach 10 m after 100 or, by rounding, 101 of them.
  EXPECT_NEAR(*result.rpe_10m_percent, 1.0, 0.0101);
  EXPECT_NEAR(*result.rpe_10m_deg, 0, 1e-9);
  EXPECT_NEAR(result.end_error_m, 1.0, 1e-9);
  // Aligned at the centre, the error grows to both ends: uniform on [0, 0.5].
  EXPECT_NEAR(result.ate_rmse_m, 0.5 / std::sqrt(3.0), 1e-3);
  EXPECT_NEAR(result.ate_max_m, 0.5, 1e-9);
}

TEST(Score, TurnOfOneDegreeInTenMetres) {
  const PoseTrajectory truth = straight(101, 1);
  PoseTrajectory estimate;
  for (size_t i = 0; i < truth.size(); ++i) {  // each step 1 m ahead, then 0.1 deg to the left
    const SE3 step(Quat(Eigen::AngleAxisd(0.1 * kDegree, Vec3::UnitZ())), {1, 0, 0});
    estimate.push_back({truth[i].stamp, i == 0 ? SE3() : estimate.back().pose * step});
  }
  const TrajectoryScore result = score(estimate, truth, {.rpe_pairs_from_truth = true});
  EXPECT_EQ(result.rpe_pairs, 9);
  EXPECT_NEAR(*result.rpe_10m_deg, 1.0, 1e-9);
  // The end of ten such steps, from the start: sum of (cos, sin) of 0, 0.1, ..., 0.9 deg.
  double x = 0, y = 0;
  for (int i = 0; i < 10; ++i) {
    x += std::cos(0.1 * i * kDegree);
    y += std::sin(0.1 * i * kDegree);
  }
  EXPECT_NEAR(*result.rpe_10m_percent, 10 * std::hypot(x - 10, y), 1e-9);
}

TEST(Score, EndErrorIsSeenFromTheFirstPose) {
  PoseTrajectory truth = straight(11, 1);
  PoseTrajectory estimate = moved(SE3::from_rpy({0, 0, 1}, {4, 4, 4}), 1, truth);
  estimate.back().pose.translation += Vec3(0, 0, 0.25);
  EXPECT_NEAR(score(estimate, truth).end_error_m, 0.25, 1e-12);
}

TEST(Score, ShortPathHasNoRelativeError) {
  const PoseTrajectory truth = straight(50, 0.1);
  const TrajectoryScore result = score(truth, truth);
  EXPECT_FALSE(result.rpe_10m_percent.has_value());
  EXPECT_FALSE(result.rpe_10m_deg.has_value());
  EXPECT_EQ(result.rpe_pairs, 0);
}

TEST(Score, RestingOrStraightTrajectoriesAlign) {
  const PoseTrajectory rest = straight(10, 0), line = straight(100, 0.2);
  EXPECT_LT(score(moved(SE3(Quat::Identity(), {1, 2, 3}), 1, rest), rest).ate_max_m, 1e-12);
  const SE3 turn = SE3::from_rpy({0, 0, std::numbers::pi}, {1, 2, 3});
  EXPECT_LT(score(moved(turn, 1, line), line).ate_max_m, 1e-9);
  const TrajectoryScore scaled = score(rest, line, {.alignment = Alignment::sim3});
  EXPECT_TRUE(std::isfinite(scaled.ate_rmse_m));
}

TEST(Score, NothingInCommonIsAnError) {
  PoseTrajectory truth = straight(10, 1), estimate = truth;
  for (auto& [stamp, pose] : estimate) stamp.ns += 50'000'000;
  EXPECT_THROW(score(estimate, truth), InputError);
  EXPECT_THROW(score({}, truth), InputError);
  EXPECT_THROW(score(estimate, {}), InputError);
}

TEST(Associate, TakesTheNearestStampWithinTheLimit) {
  PoseTrajectory truth(5), estimate(3);
  for (size_t i = 0; i < 5; ++i)
    truth[i].stamp = Time{static_cast<int64_t>(i) * 8'000'000};  // 0 8 16 24 32 ms
  estimate[0].stamp = Time{3'000'000};                           // 0 is nearest
  estimate[1].stamp = Time{12'000'000};                          // 8 and 16 tie: 8
  estimate[2].stamp = Time{42'000'000};                          // 32, just in reach
  auto pairs = associate(estimate, truth, Duration{10'000'000});
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].truth, 0u);
  EXPECT_EQ(pairs[1].truth, 1u);
  EXPECT_EQ(pairs[2].truth, 4u);
  estimate[2].stamp = Time{42'000'001};
  EXPECT_EQ(associate(estimate, truth, Duration{10'000'000}).size(), 2u);
}

TEST(Associate, GoesOverTheShorterTrajectory) {
  const PoseTrajectory dense = straight(100, 0.1);
  PoseTrajectory sparse;
  for (size_t i = 0; i < 100; i += 10) sparse.push_back(dense[i]);
  for (const auto& [i, j] : associate(dense, sparse, Duration{10'000'000})) EXPECT_EQ(i, 10 * j);
  EXPECT_EQ(associate(dense, sparse, Duration{10'000'000}).size(), 10u);
  EXPECT_EQ(associate(sparse, dense, Duration{10'000'000}).size(), 10u);
}

TEST(PairsByPath, ConsecutivePairsStartAfterTheFirstLength) {
  std::vector<Vec3> positions;
  for (int i = 0; i <= 10; ++i) positions.emplace_back(i, 0, 0);
  EXPECT_THAT(pairs_by_path(positions, 3, false, 0),
              testing::ElementsAre(std::pair(3u, 6u), std::pair(6u, 9u)));
  EXPECT_TRUE(pairs_by_path(positions, 6, false, 0).empty());
}

TEST(PairsByPath, AllPairsTakeTheNearestLengthWithinTheTolerance) {
  std::vector<Vec3> positions;
  for (const double x : {0.0, 1.0, 2.9, 3.2, 9.0}) positions.emplace_back(x, 0, 0);
  EXPECT_THAT(pairs_by_path(positions, 3, true, 0.3), testing::ElementsAre(std::pair(0u, 2u)));
  EXPECT_THAT(pairs_by_path(positions, 2, true, 0.3),
              testing::ElementsAre(std::pair(1u, 2u)));  // 1.9 is nearer than 2.2
}

TEST(Score, NoiseOfKnownSizeIsFoundAgain) {
  const PoseTrajectory truth = winding(4000);
  PoseTrajectory estimate = truth;
  const RandomStream noise(1, "test");
  for (size_t i = 0; i < estimate.size(); ++i)
    for (int k = 0; k < 3; ++k)
      estimate[i].pose.translation[k] += 0.05 * noise.normal(i, static_cast<uint64_t>(k));
  EXPECT_NEAR(score(estimate, truth).ate_rmse_m, 0.05 * std::sqrt(3.0), 0.002);
}

// Positions on a line leave the roll about it open; orientations settle it.
TEST(AlignPoses, IsDeterminedOnAStraightLine) {
  const SE3 T_world_map = SE3::from_rpy({0.3, -0.2, 2.0}, {5, -7, 1});
  std::vector<SE3> estimate, truth;
  for (int i = 0; i < 50; ++i) {
    estimate.push_back(SE3(Quat::Identity(), {0.1 * i, 0, 0}));
    truth.push_back(T_world_map * estimate.back());
  }
  EXPECT_LT((align_poses(estimate, truth).matrix4() - T_world_map.matrix4()).norm(), 1e-12);
}

}  // namespace
}  // namespace vsslam

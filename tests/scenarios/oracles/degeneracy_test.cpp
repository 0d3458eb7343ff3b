#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenarios/oracles/degeneracy_truth.h"

namespace vsslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

void add(LidarMeasurement& measurement, const Vec3& position, const Vec3& normal) {
  PointTruth point;
  point.position_lidar = position.cast<float>();
  point.normal_lidar = normal.cast<float>();
  measurement.truth.push_back(point);
}

/// A corridor along x, 2.4 m wide, floor 0.6 m below and ceiling 2.4 m above, points on a fine grid; turned by
/// `yaw`. With `end_wall_m`, a wall across it there.
LidarMeasurement corridor(double yaw = 0, double end_wall_m = 0) {
  const Mat3 R = SE3::from_rpy({0, 0, yaw}, Vec3::Zero()).matrix3();
  LidarMeasurement measurement;
  const double end = end_wall_m > 0 ? end_wall_m : 20;
  for (double x = -20; x < end; x += 0.2) {
    for (double z = -0.5; z < 2.4; z += 0.2)
      for (const double side : {-1.0, 1.0})
        add(measurement, R * Vec3(x, 1.2 * side, z), R * Vec3(0, -side, 0));
    for (double y = -1.1; y < 1.2; y += 0.2) {
      add(measurement, R * Vec3(x, y, -0.6), Vec3::UnitZ());
      add(measurement, R * Vec3(x, y, 2.4), -Vec3::UnitZ());
    }
  }
  if (end_wall_m > 0)
    for (double y = -1.1; y < 1.2; y += 0.2)
      for (double z = -0.5; z < 2.4; z += 0.2)
        add(measurement, R * Vec3(end_wall_m, y, z), R * Vec3(-1, 0, 0));
  return measurement;
}

TEST(DegeneracyTruth, EndlessCorridorDoesNotHoldItsAxis) {
  for (const double yaw : {0.0, 0.4, -2.0}) {
    const DegeneracyTruth truth = degeneracy_truth(corridor(yaw));
    EXPECT_EQ(truth.degenerate_translations, 1);
    EXPECT_EQ(truth.degenerate_rotations, 0);
    EXPECT_NEAR(truth.information.translation.eigenvalues[0] / truth.points, 0, 1e-9);
    EXPECT_GT(truth.information.translation.alpha(), 0.999);
    const Vec3 axis(std::cos(yaw), std::sin(yaw), 0);
    EXPECT_NEAR(std::abs(truth.information.translation.eigenvectors.col(0).dot(axis)), 1, 1e-9);
  }
}

TEST(DegeneracyTruth, SharesOfACorridorAreItsCountsOfPoints) {
  // Per 0.4 m of length: walls 2 x (3.0 / 0.4), floor and ceiling 2 x (2.4 / 0.4), voxel by voxel.
  const DegeneracyTruth truth = degeneracy_truth(corridor());
  const Vec3 shares = truth.information.translation.eigenvalues / truth.points;
  EXPECT_NEAR(shares.sum(), 1, 1e-9);  // |n| = 1
  EXPECT_NEAR(shares[1], 12.0 / 28, 0.05);
  EXPECT_NEAR(shares[2], 16.0 / 28, 0.05);
}

TEST(DegeneracyTruth, AnEndWallHoldsTheAxis) {
  const DegeneracyTruth truth = degeneracy_truth(corridor(0.3, 10));
  EXPECT_EQ(truth.degenerate_directions(), 0);
  EXPECT_GT(truth.information.translation.eigenvalues[0] / truth.points, 0.01);
}

TEST(DegeneracyTruth, OpenGroundHoldsHeightRollAndPitchOnly) {
  LidarMeasurement ground;
  for (double x = -10; x < 10; x += 0.3)
    for (double y = -10; y < 10; y += 0.3) add(ground, {x, y, -0.6}, Vec3::UnitZ());
  const DegeneracyTruth truth = degeneracy_truth(ground);
  EXPECT_EQ(truth.degenerate_translations, 2);
  EXPECT_EQ(truth.degenerate_rotations, 1);
  EXPECT_NEAR(std::abs(truth.information.rotation.eigenvectors.col(0).z()), 1, 1e-9);
}

TEST(DegeneracyTruth, DenserPointsChangeNothing) {
  LidarMeasurement once = corridor(0.2, 10), thrice = once;
  for (int i = 0; i < 2; ++i) thrice.truth.insert(thrice.truth.end(), once.truth.begin(), once.truth.end());
  const DegeneracyTruth a = degeneracy_truth(once), b = degeneracy_truth(thrice);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.information.H, b.information.H);
}

TEST(DegeneracyTruth, NoPointsHoldNothing) {
  const DegeneracyTruth truth = degeneracy_truth({});
  EXPECT_EQ(truth.points, 0);
  EXPECT_EQ(truth.degenerate_directions(), 6);
}

DegeneracyReport report(int directions, const Vec3& weakest_translation) {
  DegeneracyReport report{.information = {}, .degenerate_directions = directions};
  report.information.translation.eigenvectors.col(0) = weakest_translation.normalized();
  return report;
}

TEST(DegeneracyScore, CountsScansAndMeasuresDirections) {
  const DegeneracyTruth along_x = degeneracy_truth(corridor()), held = degeneracy_truth(corridor(0, 10));
  const auto tilted = [](double deg) { return Vec3(std::cos(deg * kDegree), std::sin(deg * kDegree), 0); };
  const std::vector<DegeneracyTruth> truth = {along_x, along_x, along_x, along_x, held, held};
  const std::vector<DegeneracyReport> reports = {report(1, tilted(1)),  report(1, -tilted(3)),
                                                 report(2, tilted(7)),  report(0, tilted(90)),
                                                 report(1, tilted(50)), report(0, tilted(0))};
  const DegeneracyScore score = score_degeneracy(reports, truth);
  EXPECT_EQ(score.detected, 4);
  EXPECT_EQ(score.true_degenerate, 4);
  EXPECT_EQ(score.both, 3);
  EXPECT_EQ(score.precision, 0.75);
  EXPECT_EQ(score.recall, 0.75);
  EXPECT_NEAR(*score.direction_error_deg_median, 3, 1e-5);
}

TEST(DegeneracyScore, AnyDirectionOfATrulyDegeneratePlaneIsRight) {
  DegeneracyTruth truth;
  truth.degenerate_translations = 2;
  truth.information.translation.eigenvectors = Mat3::Identity();
  const DegeneracyReport inside = report(2, {1, 2, 0}), outside = report(2, {1, 0, 1});
  EXPECT_NEAR(*score_degeneracy({&inside, 1}, {&truth, 1}).direction_error_deg_median, 0, 1e-5);
  EXPECT_NEAR(*score_degeneracy({&outside, 1}, {&truth, 1}).direction_error_deg_median, 45, 1e-9);
}

TEST(DegeneracyScore, NothingDegenerateHasNoScore) {
  const DegeneracyScore score = score_degeneracy({}, {});
  EXPECT_FALSE(score.precision || score.recall || score.direction_error_deg_median);
}

}  // namespace
}  // namespace vsslam

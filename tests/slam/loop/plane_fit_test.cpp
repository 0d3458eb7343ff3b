#include "slam/loop/plane_fit.h"

#include <gtest/gtest.h>

#include "tests/slam/loop/loop_room.h"

namespace vsslam {
namespace {

void add_wall(double x0, double x1, double y, double spacing_m, Cloud& cloud) {
  for (double x = x0; x < x1; x += spacing_m)
    for (double z = 0.6; z < 2.4; z += spacing_m) cloud.push_back(Vec3(x, y, z).cast<float>());
}

void add_floor(double x0, double x1, double spacing_m, Cloud& cloud) {
  for (double x = x0; x < x1; x += spacing_m)
    for (double y = -1.1; y < 1.1; y += spacing_m) cloud.push_back(Vec3(x, y, 0).cast<float>());
}

void add_end(double x, double spacing_m, Cloud& cloud) {
  for (double y = -1.1; y < 1.1; y += spacing_m)
    for (double z = 0.6; z < 2.4; z += spacing_m) cloud.push_back(Vec3(x, y, z).cast<float>());
}

// A corridor along x, 3 m wide.
Cloud corridor(double x0, double x1, double spacing_m) {
  Cloud cloud;
  add_wall(x0, x1, -1.5, spacing_m, cloud);
  add_wall(x0, x1, 1.5, spacing_m, cloud);
  add_floor(x0, x1, spacing_m, cloud);
  return cloud;
}

Cloud seen_from(const SE3& T_target_source, const Cloud& cloud_target) {
  Cloud cloud_source;
  for (const Eigen::Vector3f& p : cloud_target)
    cloud_source.push_back((T_target_source.inverse() * p.cast<double>()).cast<float>());
  return cloud_source;
}

const SE3 kTruth = planar(4, 0.3, 0.2, 0.5);
// What the motions below are in the target's frame: about the source, along the corridor and across.
SE3 off_by(double along_m, double across_m, double yaw_rad) {
  return SE3(Quat::Identity(), {along_m, across_m, 0}) * kTruth * planar(0, 0, yaw_rad);
}
Vec3 error_m(const SE3& T_target_source) {
  return T_target_source.translation - kTruth.translation;
}

// The map ends at 8 m; the scan sees another 4 m, which draw point-to-point ICP back.
TEST(PlaneFit, KeepsWhatIsExpectedAlongACorridorAndMeasuresTheRest) {
  const IcpTarget target(corridor(-10, 8, 0.2));
  const Cloud source = seen_from(kTruth, corridor(-3, 12, 0.23));
  const SE3 expected = off_by(0.07, -0.1, 0.02);
  const IcpResult icp = align(source, target, expected, {}, 0.5);
  EXPECT_LT(error_m(icp.T_target_source).x(), -0.1);
  for (const SE3& start : {icp.T_target_source, off_by(-1.8, 0.05, 0.01)}) {
    const PlaneFit fit = fit_to_planes(source, target, start, expected, {});
    EXPECT_TRUE(fit.converged);
    EXPECT_EQ(fit.degeneracy.directions, 1);
    EXPECT_LT(fit.degeneracy.shares[0], 1e-6);
    EXPECT_NEAR(error_m(fit.T_target_source).x(), 0.07, 1e-3);
    EXPECT_LT(error_m(fit.T_target_source).tail<2>().norm(), 1e-4);
    EXPECT_LT((fit.T_target_source.rotation.inverse() * kTruth.rotation).vec().norm(), 1e-4);
  }
}

TEST(PlaneFit, CorrectsDriftThatAnEndWallShows) {
  Cloud room = corridor(-10, 8, 0.2), seen = corridor(-3, 8, 0.23);
  add_end(8.3, 0.2, room);
  add_end(8.3, 0.23, seen);
  const SE3 expected = off_by(0.4, 0.1, 0.01);
  const PlaneFit fit = fit_to_planes(seen_from(kTruth, seen), IcpTarget(room), expected, expected, {});
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.degeneracy.directions, 0);
  EXPECT_LT(error_m(fit.T_target_source).norm(), 1e-3);
}

TEST(PlaneFit, WithoutPlanesTheStartStands) {
  Cloud bushes;  // evenly spread in a cube of 6 m
  for (int i = 0; i < 3000; ++i)
    bushes.push_back(6 * Vec3(std::fmod(i * 0.8191725134, 1.0), std::fmod(i * 0.6710436067, 1.0),
                              std::fmod(i * 0.5497004779, 1.0))
                             .cast<float>());
  const SE3 start = planar(0.02, 0, 0);
  PlaneFitConfig config;
  config.min_pairs = 300;
  const PlaneFit fit = fit_to_planes(bushes, IcpTarget(bushes), start, SE3(), config);
  EXPECT_EQ(fit.iterations, 0);
  EXPECT_FALSE(fit.converged);
  EXPECT_EQ(fit.T_target_source.translation, start.translation);
}

}  // namespace
}  // namespace vsslam

#include "slam/lidar/registration.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "slam/lidar/lidar_odometry.h"
#include "slam/undistort.h"
#include "tests/slam/analytic_scene.h"

namespace vsslam {
namespace {

using namespace testing_scene;

Motion resting(const SE3& T_scene_base) {
  return [=](double) { return T_scene_base; };
}
SE3 at_x(double x_m) {
  return {Quat::Identity(), {x_m, 0.1, 0.2}};
}

constexpr double kSigma_m = 0.007;

std::vector<Feature> features_at(const Scene& scene, const SE3& T_scene_base, Time stamp = {}) {
  const LidarScan s = scan(scene, resting(T_scene_base), rig(), stamp);
  return select_planar_features(s, undistort(s, MotionPath(stamp), rig().lidar.T_base_lidar), kSigma_m, {});
}

// A local map from scans along the axis; the odom frame is the scene's.
struct Mapped {
  LidarOdometryConfig config;
  LidarOdometry odometry;
  explicit Mapped(const Scene& scene, int scans = 12, const LidarOdometryConfig& settings = {})
      : config(settings), odometry(config, kSigma_m) {
    for (int i = 0; i < scans; ++i)
      odometry.insert_key(thin_features(features_at(scene, at_x(i - 0.5 * scans), ms(i)), odometry.map_voxel_m()),
                          at_x(i - 0.5 * scans), rig().lidar.T_base_lidar);
  }
  static Time ms(int i) { return Time{1'000'000 * int64_t{i}}; }
  Registration align(const Scene& scene, const SE3& T_scene_base, const Vec6& offset) {
    const auto features = thin_features(features_at(scene, T_scene_base, ms(500)), odometry.voxel_m());
    return odometry.align(features,
                          {T_scene_base * rig().lidar.T_base_lidar * SE3::exp(offset), claimed_covariance()});
  }
  // The prior's: 0.05 rad, 0.08 m; the offsets below are within it.
  static Mat6 claimed_covariance() {
    Vec6 variances;
    variances << Vec3::Constant(2.5e-3), Vec3::Constant(6.4e-3);
    return variances.asDiagonal();
  }
};

TEST(PointToPlane, RowIsTheDerivativeOfTheResidual) {
  const SE3 T = SE3::from_rpy({0.3, -0.2, 1.1}, {2, -1, 0.5});
  const Vec3 p(4, -3, 1.5), n = Vec3(0.2, -0.9, 0.4).normalized();
  const Vec6 row = point_to_plane_row(p, T.rotation.conjugate() * n);
  constexpr double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Vec6 step = h * Vec6::Unit(k);
    const double slope = n.dot(T * SE3::exp(step) * p - T * SE3::exp(-step) * p) / (2 * h);
    EXPECT_NEAR(row[k], slope, 1e-8) << k;
  }
}

TEST(Registration, FindsThePoseInARoom) {
  Mapped mapped(room(), 4);
  Vec6 offset;
  offset << 0.01, -0.01, 0.03, 0.08, -0.06, 0.04;
  double mean_m = 0, mean_rad = 0;
  constexpr int kPlaces = 5;
  for (int i = 0; i < kPlaces; ++i) {
    const SE3 T_scene_base = at_x(0.1 + 0.1 * i);
    const Registration r = mapped.align(room(), T_scene_base, offset);
    EXPECT_TRUE(r.converged);
    EXPECT_EQ(r.degeneracy.directions, 0);
    const SE3 error = (T_scene_base * rig().lidar.T_base_lidar).inverse() * r.T_odom_lidar;
    EXPECT_LT(error.translation.norm(), 0.006);
    EXPECT_LT(error.angle(), 0.002);
    mean_m += error.translation.norm() / kPlaces;
    mean_rad += error.angle() / kPlaces;
  }
  EXPECT_LT(mean_m, 0.003);
  EXPECT_LT(mean_rad, 0.001);
}

TEST(Registration, KeepsThePriorAlongAnEndlessCorridorOnly) {
  const Scene scene = corridor(400);
  Mapped mapped(scene);
  Vec6 offset;
  offset << 0.005, -0.005, 0.01, 0.07, -0.05, 0.03;
  const Registration r = mapped.align(scene, at_x(0.5), offset);
  ASSERT_EQ(r.degeneracy.directions, 1);
  EXPECT_LT(r.degeneracy.shares[0], 2e-4);  // what fitted normals feign, far below the threshold
  EXPECT_GT(r.information.translation.alpha(), 0.999);
  EXPECT_GT(std::abs(r.information.translation.eigenvectors.col(0).x()), 0.999);
  const SE3 error = (at_x(0.5) * rig().lidar.T_base_lidar).inverse() * r.T_odom_lidar;
  EXPECT_NEAR(error.translation.x(), 0.07, 0.005);  // the prior's error stays
  EXPECT_NEAR(error.translation.y(), 0, 0.003);
  EXPECT_NEAR(error.translation.z(), 0, 0.004);
  EXPECT_LT(error.angle(), 0.0015);
}

TEST(Registration, SeesAlongACorridorWithJambs) {
  const Scene scene = jambed_corridor(60, 4, 0.15);
  Mapped mapped(scene);
  const Registration r = mapped.align(scene, at_x(0.5), (Vec6() << 0, 0, 0, 0.05, 0, 0).finished());
  EXPECT_EQ(r.degeneracy.directions, 0);
  const SE3 error = (at_x(0.5) * rig().lidar.T_base_lidar).inverse() * r.T_odom_lidar;
  EXPECT_LT(error.translation.norm(), 0.01);
}

TEST(Registration, LeavesThePriorAloneWithoutAMap) {
  LidarOdometry odometry({}, kSigma_m);
  const SE3 prior = at_x(3);
  const Registration r = odometry.align(features_at(room(), at_x(0)), {prior, 1e-4 * Mat6::Identity()});
  EXPECT_TRUE(r.used_prior_only);
  EXPECT_EQ(r.degeneracy.directions, 6);
  EXPECT_EQ(r.T_odom_lidar.translation, prior.translation);
}

TEST(Degeneracy, ShareDoesNotDependOnTheNumberOfPoints) {
  Mat6 H = Mat6::Zero();
  for (int i = 0; i < 30; ++i) {
    const Vec6 row = point_to_plane_row({0.3 * i - 4, 1.0, 0.1 * i}, Vec3(0.1, 1, 0.05 * i).normalized());
    H += row * row.transpose();
  }
  const Degeneracy once = detect_degeneracy(H, 30, {}), often = detect_degeneracy(17 * H, 17 * 30, {});
  EXPECT_LT((once.shares - often.shares).norm(), 1e-9);
  EXPECT_EQ(once.directions, often.directions);
}

TEST(Degeneracy, SolvesInTheObservedSubspaceOnly) {
  // Walls left and right, floor: nothing along x.
  Mat6 H = Mat6::Zero();
  for (int i = -10; i <= 10; ++i)
    for (const auto& [p, n] : {std::pair<Vec3, Vec3>{{1.0 * i, 1.2, 0.3}, Vec3::UnitY()},
                               {{1.0 * i, -1.2, 0.9}, -Vec3::UnitY()},
                               {{1.0 * i, 0.4, -0.6}, Vec3::UnitZ()}}) {
      const Vec6 row = point_to_plane_row(p, n);
      H += row * row.transpose();
    }
  const Degeneracy found = detect_degeneracy(H, 63, {});
  ASSERT_EQ(found.directions, 1);
  Vec6 x;
  x << 0.01, 0.02, -0.01, 0.5, 0.1, -0.2;
  const Vec6 solved = found.solve(H, H * x);
  EXPECT_NEAR(solved[3], 0, 1e-9);
  x[3] = 0;
  EXPECT_LT((solved - x).norm(), 1e-9);
  EXPECT_NEAR(found.observed_translation()(0, 0), 0, 1e-9);
  EXPECT_NEAR(found.observed_translation()(1, 1), 1, 1e-9);
  EXPECT_TRUE(found.observed_rotation().isApprox(Mat3::Identity(), 1e-9));
}

// A scene that leaves some directions of the pose open, oblique to the axes.
Degeneracy oblique(int directions, double characteristic_length_m) {
  const Mat6 random = Mat6::NullaryExpr([](Eigen::Index row, Eigen::Index column) {
    return std::sin(1.0 + 5.0 * static_cast<double>(row) + 7.3 * static_cast<double>(column));
  });
  const Eigen::SelfAdjointEigenSolver<Mat6> basis(random * random.transpose());
  Vec6 shares = Vec6::Constant(0.3);
  shares.head(directions).setConstant(1e-4);
  Vec6 scale = Vec6::Ones();
  scale.head<3>().setConstant(characteristic_length_m);
  const Mat6 scaled = basis.eigenvectors() * shares.asDiagonal() * basis.eigenvectors().transpose();
  const Mat6 H = scale.asDiagonal() * scaled * scale.asDiagonal();
  return detect_degeneracy(H, 1, {.min_share = 0.01, .characteristic_length_m = characteristic_length_m});
}

TEST(Degeneracy, UnseenPartAndSolutionShareTheStepBetweenThem) {
  Vec6 step;
  step << 0.01, -0.02, 0.03, 0.4, -0.5, 0.6;
  for (int directions : {0, 2, 6}) {
    const Degeneracy found = oblique(directions, 2.5);
    ASSERT_EQ(found.directions, directions);
    const Vec6 unseen = found.unseen_part(step);
    EXPECT_LT((found.unseen_part(unseen) - unseen).norm(), 1e-12);
    EXPECT_LT(found.unseen_part(step - unseen).norm(), 1e-12);
    const Vec6 solved = found.solve(Mat6::Identity(), step);
    EXPECT_LT(found.unseen_part(solved).norm(), 1e-12);
  }
}

TEST(Degeneracy, InformationKeepsTheCovarianceOfWhatWasMeasured) {
  Vec6 seen;
  seen << Vec3::Constant(1e-6), Vec3::Constant(1e-4);
  EXPECT_TRUE(oblique(0, 2.5).information(seen, 0.5).isApprox(Mat6(seen.cwiseInverse().asDiagonal()), 1e-9));

  Vec6 scale = Vec6::Ones();
  scale.head<3>().setConstant(2.5);
  for (int directions : {1, 2, 6}) {
    const Degeneracy found = oblique(directions, 2.5);
    const Mat6 covariance = found.information(seen, 0.5).inverse();
    // of the scaled pose, along the eigenvectors
    const Mat6 along = found.scaled_eigenvectors.transpose() * scale.asDiagonal() * covariance *
                       scale.asDiagonal() * found.scaled_eigenvectors;
    const Mat6 measured = found.scaled_eigenvectors.transpose() * scale.asDiagonal() * seen.asDiagonal() *
                          scale.asDiagonal() * found.scaled_eigenvectors;
    const int kept = 6 - directions;
    EXPECT_TRUE(along.topLeftCorner(directions, directions)
                    .isApprox(0.5 * Eigen::MatrixXd::Identity(directions, directions), 1e-6));
    EXPECT_LT((along.bottomRightCorner(kept, kept) - measured.bottomRightCorner(kept, kept)).norm(), 1e-9);
    EXPECT_LT(along.topRightCorner(directions, kept).norm(), 1e-9);
  }
}

TEST(Information, BlocksOfARoomAndOfAPlane) {
  Mat6 H = Mat6::Zero();
  H.diagonal() << 4, 9, 16, 1, 2, 10;
  const Information info = analyse_information(H);
  EXPECT_NEAR(info.translation.alpha(), 0.9, 1e-12);
  EXPECT_NEAR(info.rotation.alpha(), 0.75, 1e-12);
  EXPECT_NEAR(analyse_information(Mat6::Zero()).translation.alpha(), 1.0, 1e-12);
}

}  // namespace
}  // namespace vsslam

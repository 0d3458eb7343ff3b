#include <gtest/gtest.h>

#include <functional>

#include "core/rng.h"
#include "slam/vio/imu_factor.h"
#include "slam/vio/linear_prior.h"
#include "slam/vio/reprojection_factor.h"
#include "slam/vio/rest_factor.h"
#include "slam/vio/vio_predict.h"

namespace vsslam {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Block {
  VariableKind kind;
  std::array<double, 9> x{};
};

Block pose(const SE3& T) {
  Block block{VariableKind::pose, {}};
  const PoseBlock values = to_block(T);
  std::copy(values.begin(), values.end(), block.x.begin());
  return block;
}
Block motion(const Vec3& v, const Vec3& gyro, const Vec3& accel) {
  Block block{VariableKind::motion, {}};
  Eigen::Map<Eigen::Matrix<double, 9, 1>>{block.x.data()} << v, gyro, accel;
  return block;
}
Block inverse_point(const Vec2& ray, double rho) {
  return {VariableKind::point, {ray.x(), ray.y(), rho}};
}
Block inverse_point(const Vec3& point) {
  return inverse_point(point.hnormalized(), 1 / point.z());
}

int size_of(const Block& block) {
  return block.kind == VariableKind::pose ? 7 : tangent_size(block.kind);
}

Eigen::VectorXd residuals(const ceres::CostFunction& cost, const std::vector<Block>& blocks) {
  std::vector<const double*> x;
  for (const Block& block : blocks) x.push_back(block.x.data());
  Eigen::VectorXd r(cost.num_residuals());
  EXPECT_TRUE(cost.Evaluate(x.data(), r.data(), nullptr));
  return r;
}

Block moved(const Block& block, int direction, double by) {
  Block out = block;
  if (block.kind == VariableKind::pose) {
    Vec6 xi = Vec6::Zero();
    xi[direction] = by;
    PoseManifold().Plus(block.x.data(), xi.data(), out.x.data());
  } else {
    out.x[static_cast<size_t>(direction)] += by;
  }
  return out;
}

// Every column of every Jacobian against central differences along the tangent.
void expect_slopes(const ceres::CostFunction& cost, const std::vector<Block>& blocks, double step,
                   double tolerance) {
  std::vector<const double*> x;
  std::vector<RowMajor> J;
  std::vector<double*> out;
  for (const Block& block : blocks) {
    x.push_back(block.x.data());
    J.push_back(RowMajor::Constant(cost.num_residuals(), size_of(block), 1e9));
  }
  for (RowMajor& j : J) out.push_back(j.data());
  Eigen::VectorXd r(cost.num_residuals());
  ASSERT_TRUE(cost.Evaluate(x.data(), r.data(), out.data()));
  for (size_t k = 0; k < blocks.size(); ++k)
    for (int d = 0; d < tangent_size(blocks[k].kind); ++d) {
      std::vector<Block> plus = blocks, minus = blocks;
      plus[k] = moved(blocks[k], d, step);
      minus[k] = moved(blocks[k], d, -step);
      const Eigen::VectorXd numeric = (residuals(cost, plus) - residuals(cost, minus)) / (2 * step);
      const double scale = 1 + numeric.norm();
      EXPECT_LT((numeric - J[k].col(d)).norm() / scale, tolerance) << "block " << k << ", direction " << d;
      EXPECT_LT((numeric - J[k].col(d)).cwiseAbs().maxCoeff() / scale, tolerance);
    }
}

const SE3 kPoseA = SE3::from_rpy({0.1, -0.2, 0.7}, {1, 2, 0.5}),
          kPoseB = SE3::from_rpy({0.15, -0.1, 0.9}, {1.3, 2.4, 0.45});

ImuPreintegration some_motion() {
  ImuPreintegration motion(ImuCalibration{}, {{0.01, -0.02, 0.005}, {0.1, 0.05, -0.08}});
  for (int i = 0; i < 40; ++i) {
    const double t = 0.01 * i;
    const Vec3 gyro(0.3 * std::sin(3 * t), 0.2, 0.5 * std::cos(t)),
        accel(0.4, std::sin(5 * t), 9.7 + 0.3 * std::cos(4 * t));
    motion.add(0.01, gyro, accel, gyro + Vec3(0.01, 0, 0), accel + Vec3(0, 0.01, 0));
  }
  return motion;
}

TEST(ImuFactor, SlopesAgreeWithDifferences) {
  const ImuPreintegration between = some_motion();
  const ImuFactor factor(between, ImuCalibration{});
  expect_slopes(factor,
                {pose(kPoseA), motion({0.5, 0.2, -0.1}, {0.012, -0.018, 0.007}, {0.12, 0.02, -0.05}),
                 pose(kPoseB), motion({0.6, 0.3, -0.2}, {0.013, -0.02, 0.006}, {0.11, 0.03, -0.04})},
                1e-6, 1e-5);
}

TEST(ImuFactor, IsZeroWhereThePreintegrationLeads) {
  const ImuPreintegration between = some_motion();
  VioState a{{}, kPoseA, {0.5, 0.2, -0.1}, between.bias()};
  const VioState b = predict(a, between, ImuCalibration{}.gravity_mps2);
  const ImuFactor factor(between, ImuCalibration{});
  const auto of = [](const VioState& s) { return motion(s.v_vio_mps, s.bias.gyro_radps, s.bias.accel_mps2); };
  EXPECT_LT(residuals(factor, {pose(a.T_vio_imu), of(a), pose(b.T_vio_imu), of(b)}).norm(), 1e-6);
  // A velocity that is off by one sigma of the preintegrated velocity costs about one, more for what goes with it.
  VioState off = b;
  off.v_vio_mps += a.T_vio_imu.rotation * Vec3(std::sqrt(between.covariance()(3, 3)), 0, 0);
  EXPECT_GT(residuals(factor, {pose(a.T_vio_imu), of(a), pose(b.T_vio_imu), of(off)}).norm(), 0.99);
}

TEST(ImuFactor, FollowsTheBiasToFirstOrder) {
  const ImuPreintegration between = some_motion();
  const ImuBias other{between.bias().gyro_radps + Vec3(2e-3, -1e-3, 1e-3),
                      between.bias().accel_mps2 + Vec3(0.02, 0.01, -0.01)};
  VioState a{{}, kPoseA, {0.5, 0.2, -0.1}, other};
  const VioState b = predict(a, between.corrected(other), ImuCalibration{}.gravity_mps2);
  const auto of = [](const VioState& s) { return motion(s.v_vio_mps, s.bias.gyro_radps, s.bias.accel_mps2); };
  const ImuFactor factor(between, ImuCalibration{});
  EXPECT_LT(residuals(factor, {pose(a.T_vio_imu), of(a), pose(b.T_vio_imu), of(b)}).norm(), 1e-6);
}

TEST(RestFactor, SlopesAgreeWithDifferences) {
  const RestFactor factor({{0.01, 0.02, -0.01}, {0.3, -0.2, 9.75}, 0.8}, 1.5, ImuCalibration{});
  expect_slopes(factor,
                {pose(kPoseA), motion({0.02, 0.01, 0}, {0.01, 0, 0}, {0.1, 0.2, 0}), pose(kPoseB),
                 motion({0.01, -0.01, 0.02}, {0.02, 0, 0.01}, {0.1, 0.1, -0.1})},
                1e-6, 1e-5);
}

TEST(RestFactor, IsZeroAtRest) {
  const ImuBias bias{{0.01, 0.02, -0.01}, {0.1, 0.05, -0.02}};
  const Vec3 force = kPoseA.rotation.conjugate() * Vec3(0, 0, ImuCalibration{}.gravity_mps2);
  const RestFactor factor({bias.gyro_radps, force + bias.accel_mps2, 2}, 60, ImuCalibration{});
  const Block still = motion(Vec3::Zero(), bias.gyro_radps, bias.accel_mps2);
  EXPECT_LT(residuals(factor, {pose(kPoseA), still, pose(kPoseA), still}).norm(), 1e-9);
}

const SE3 kImuCamera = SE3(Quat(0.5, -0.5, 0.5, -0.5) * so3_exp({0.05, 0.02, -0.03}), {0.2, -0.1, 0.05});

TEST(ReprojectionFactor, SlopesAgreeWithDifferences) {
  for (const double rho : {0.3, 0.02, 0.0, -0.01}) {
    const ReprojectionFactor factor(kImuCamera, {0.25, -0.05}, 460 / 1.5);
    expect_slopes(factor, {pose(kPoseA), pose(kPoseB), inverse_point({0.2, -0.1}, rho)}, 1e-6, 1e-6);
  }
}

TEST(ReprojectionFactor, SeesAPointWhereItIs) {
  const SE3 T_vio_a = kPoseA * kImuCamera, T_vio_b = kPoseB * kImuCamera;
  const Vec3 point_a(0.6, -0.3, 3.0), point_b = T_vio_b.inverse() * (T_vio_a * point_a);
  ASSERT_GT(point_b.z(), 1);
  const Vec2 ray_b = point_b.hnormalized();
  const ReprojectionFactor exact(kImuCamera, ray_b, 460);
  EXPECT_LT(residuals(exact, {pose(kPoseA), pose(kPoseB), inverse_point(point_a)}).norm(), 1e-9);
  const ReprojectionFactor two_pixels(kImuCamera, ray_b + Vec2(2.0 / 460, 0), 460);
  EXPECT_NEAR(residuals(two_pixels, {pose(kPoseA), pose(kPoseB), inverse_point(point_a)}).norm(), 2, 1e-9);
  const DepthFactor depth(kImuCamera, point_b.z(), 0.02);
  EXPECT_NEAR(residuals(depth, {pose(kPoseA), pose(kPoseB), inverse_point(point_a)})[0], 0, 1e-9);
}

TEST(ReprojectionFactor, BehindTheCameraItPullsNowhere) {
  const SE3 turned = kPoseA * SE3::from_rpy({0, 0, 3}, Vec3::Zero());
  const ReprojectionFactor factor(kImuCamera, {0, 0}, 460);
  const Block a = pose(kPoseA), b = pose(turned), point = inverse_point({0, 0}, 0.2);
  const double* x[] = {a.x.data(), b.x.data(), point.x.data()};
  Eigen::Vector2d r;
  RowMajor J(2, 7);
  double* out[] = {J.data(), nullptr, nullptr};
  ASSERT_TRUE(factor.Evaluate(x, r.data(), out));
  EXPECT_TRUE(r.allFinite());
  EXPECT_EQ(J.norm(), 0);
}

TEST(AnchorRayFactor, IsTheReprojectionIntoTheAnchorItself) {
  const Block point = inverse_point({0.2, -0.1}, 0.3);
  const AnchorRayFactor factor({0.25, -0.05}, 460 / 1.5);
  expect_slopes(factor, {point}, 1e-6, 1e-7);
  const ReprojectionFactor twin(kImuCamera, {0.25, -0.05}, 460 / 1.5);
  const Eigen::VectorXd r = residuals(twin, {pose(kPoseA), pose(kPoseA), point});
  EXPECT_LT((residuals(factor, {point}) - r).norm(), 1e-9);
}

TEST(DepthFactor, SlopesAgreeWithDifferences) {
  const Block point = inverse_point({0.2, -0.1}, 0.3);
  expect_slopes(DepthFactor(kImuCamera, 3.5, 0.02), {pose(kPoseA), pose(kPoseB), point}, 1e-6, 1e-7);
  expect_slopes(AnchorDepthFactor(3.5, 0.02), {point}, 1e-6, 1e-7);
}

TEST(PriorFactor, SlopesAgreeWithDifferences) {
  VioState at{{}, kPoseA, {0.5, 0.2, -0.1}, {{0.01, 0, 0}, {0.1, 0, 0}}};
  const LinearPrior prior = prior_of_state(5, at, {0.01, 0.02, 0.03, 0.1, 0.001, 0.05});
  expect_slopes(PriorFactor(prior), {pose(kPoseB), motion({0.4, 0.3, 0}, {0, 0.01, 0}, {0, 0.1, 0.05})}, 1e-6,
                1e-6);
}

TEST(PriorFactor, TiltIsAboutTheAxesOfVio) {
  const VioState at{{}, kPoseA, Vec3::Zero(), {}};
  const LinearPrior prior = prior_of_state(0, at, {0.01, 1.0, 0.1, 1, 1, 1});
  const auto turned = [&](const Vec3& about) {
    return residuals(PriorFactor(prior), {pose(SE3(so3_exp(about) * kPoseA.rotation, kPoseA.translation)),
                                          motion(Vec3::Zero(), Vec3::Zero(), Vec3::Zero())})
        .norm();
  };
  EXPECT_NEAR(turned({0, 0, 0.01}), 0.01, 1e-6);
  EXPECT_NEAR(turned({0.01, 0, 0}), 1, 1e-4);
  EXPECT_NEAR(turned({0, 0.01, 0}), 1, 1e-4);
}

}  // namespace
}  // namespace vsslam

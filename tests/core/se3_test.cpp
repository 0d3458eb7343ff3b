#include "core/se3.h"

#include <gtest/gtest.h>

#include "core/rng.h"

namespace vsslam {
namespace {

Vec6 random_tangent(uint64_t i, double scale) {
  const RandomStream s(3, "tangent");
  Vec6 xi;
  for (int k = 0; k < 6; ++k) xi[k] = scale * s.normal(i, static_cast<uint64_t>(k));
  return xi;
}

TEST(Se3, GroupLaws) {
  for (uint64_t i = 0; i < 50; ++i) {
    const SE3 a = SE3::exp(random_tangent(3 * i, 1)), b = SE3::exp(random_tangent(3 * i + 1, 1)),
              c = SE3::exp(random_tangent(3 * i + 2, 1));
    EXPECT_LT((((a * b) * c).matrix4() - (a * (b * c)).matrix4()).norm(), 1e-12);
    EXPECT_LT(((a * a.inverse()).matrix4() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
    EXPECT_LT(((a * b).matrix4() - a.matrix4() * b.matrix4()).norm(), 1e-12);
  }
}

TEST(Se3, ExpAndLogInvert) {
  for (double scale : {1e-9, 1e-6, 1e-3, 0.1, 0.7})
    for (uint64_t i = 0; i < 30; ++i) {
      const Vec6 xi = random_tangent(i, scale);
      EXPECT_LT((SE3::exp(xi).log() - xi).norm(), 1e-9 * std::max(scale, 1e-3)) << scale;
    }
}

TEST(Se3, ExpAgreesWithTheMatrixSeries) {
  const Vec6 xi = random_tangent(4, 0.5);
  Eigen::Matrix4d x = Eigen::Matrix4d::Zero(), term = Eigen::Matrix4d::Identity(), sum = term;
  x.topLeftCorner<3, 3>() = hat(xi.head<3>());
  x.topRightCorner<3, 1>() = xi.tail<3>();
  for (int k = 1; k < 30; ++k) sum += term = term * x / k;
  EXPECT_LT((SE3::exp(xi).matrix4() - sum).norm(), 1e-12);
}

TEST(Se3, AdjointMovesAPerturbationAcross) {
  for (uint64_t i = 0; i < 20; ++i) {
    const SE3 t = SE3::exp(random_tangent(i, 1));
    const Vec6 xi = random_tangent(i + 100, 0.3);
    EXPECT_LT(((t * SE3::exp(xi) * t.inverse()).matrix4() - SE3::exp(t.adjoint() * xi).matrix4()).norm(), 1e-11);
  }
}

TEST(Se3, RightJacobiansAgreeWithDifferences) {
  for (double scale : {1e-7, 0.003, 0.05, 0.8})
    for (uint64_t i = 0; i < 10; ++i) {
      const Vec6 xi = random_tangent(i, scale);
      const Vec3 phi = xi.head<3>();
      const SE3 t = SE3::exp(xi);
      const double h = 1e-6;
      for (int k = 0; k < 6; ++k) {
        Vec6 d = Vec6::Zero();
        d[k] = h;
        const Vec6 slope = ((t * SE3::exp(d)).log() - (t * SE3::exp(-d)).log()) / (2 * h);
        EXPECT_LT((slope - se3_right_jacobian_inverse(xi).col(k)).norm(), 2e-8) << scale;
      }
      EXPECT_LT((so3_right_jacobian(phi) * so3_right_jacobian_inverse(phi) - Mat3::Identity()).norm(), 1e-10);
      for (int k = 0; k < 3; ++k) {
        const Vec3 d = h * Vec3::Unit(k);
        const Vec3 slope =
            so3_log(so3_exp(phi).conjugate() * so3_exp(phi + d)) - so3_log(so3_exp(phi).conjugate() * so3_exp(phi - d));
        EXPECT_LT((slope / (2 * h) - so3_right_jacobian(phi).col(k)).norm(), 2e-8);
      }
    }
}

TEST(Se3, RollPitchYaw) {
  const Vec3 rpy(0.1, -0.4, 2.5);
  const SE3 t = SE3::from_rpy(rpy, {1, 2, 3});
  EXPECT_LT((t.rpy() - rpy).norm(), 1e-12);
  EXPECT_LT((SE3::from_rpy({0, 0, M_PI / 2}, Vec3::Zero()) * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(Se3, LogNearHalfTurnAndOppositeQuaternion) {
  const Vec3 phi = Vec3(1, 2, -2).normalized() * (M_PI - 1e-9);
  EXPECT_LT((so3_log(so3_exp(phi)) - phi).norm(), 1e-7);
  const Quat q = so3_exp({0.1, 0.2, 0.3});
  EXPECT_LT((so3_log(q) - so3_log(Quat(-q.coeffs()))).norm(), 1e-15);
}

TEST(Se3, InterpolateMeetsItsEnds) {
  const SE3 a = SE3::exp(random_tangent(1, 0.5)), b = SE3::exp(random_tangent(2, 0.5));
  EXPECT_LT((interpolate(a, b, 0).matrix4() - a.matrix4()).norm(), 1e-12);
  EXPECT_LT((interpolate(a, b, 1).matrix4() - b.matrix4()).norm(), 1e-12);
}

}  // namespace
}  // namespace vsslam

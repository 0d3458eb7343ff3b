#include "slam/inertial/preintegration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"

namespace vsslam {
namespace {

struct Rates {
  Vec3 gyro_radps, accel_mps2;
};
Rates rates(double t) {
  return {{0.3 * std::sin(2 * t), -0.2 + 0.1 * std::cos(3 * t), 0.5 * std::sin(t + 1)},
          {0.5 * std::cos(4 * t), 0.4 * std::sin(2 * t), 9.8 + 0.3 * std::sin(5 * t)}};
}

ImuPreintegration integrate(
    double duration_s, double step_s, const ImuBias& bias, const std::function<Rates(int)>& noise = [](int) {
      return Rates{Vec3::Zero(), Vec3::Zero()};
    }) {
  ImuPreintegration motion(ImuCalibration{}, bias);
  const int steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i < steps; ++i) {
    const Rates a = rates(i * step_s), b = rates((i + 1) * step_s), na = noise(i), nb = noise(i + 1);
    motion.add(step_s, a.gyro_radps + na.gyro_radps, a.accel_mps2 + na.accel_mps2,
               b.gyro_radps + nb.gyro_radps, b.accel_mps2 + nb.accel_mps2);
  }
  return motion;
}

// [phi; v; p] of b relative to a.
Eigen::Matrix<double, 9, 1> difference(const ImuPreintegration& a, const ImuPreintegration& b) {
  Eigen::Matrix<double, 9, 1> e;
  e << so3_log(a.delta_R().conjugate() * b.delta_R()), b.delta_v() - a.delta_v(), b.delta_p() - a.delta_p();
  return e;
}

TEST(Preintegration, AgreesWithFineIntegration) {
  const ImuPreintegration coarse = integrate(1.0, 0.01, {}), fine = integrate(1.0, 1e-4, {});
  EXPECT_NEAR(coarse.dt_s(), 1.0, 1e-12);
  const auto e = difference(fine, coarse);
  EXPECT_LT(e.head<3>().norm(), 3e-5);
  EXPECT_LT(e.segment<3>(3).norm(), 3e-4);
  EXPECT_LT(e.tail<3>().norm(), 3e-4);
}

TEST(Preintegration, ErrorFallsWithTheSquareOfTheStep) {
  const ImuPreintegration fine = integrate(1.0, 1e-4, {});
  const double coarse = difference(fine, integrate(1.0, 0.02, {})).norm();
  const double half = difference(fine, integrate(1.0, 0.01, {})).norm();
  EXPECT_NEAR(coarse / half, 4.0, 0.3);
}

TEST(Preintegration, ConstantAccelerationIsTheParabola) {
  ImuPreintegration motion(ImuCalibration{}, {});
  const Vec3 a(1, -2, 0.5);
  for (int i = 0; i < 50; ++i) motion.add(0.01, Vec3::Zero(), a, Vec3::Zero(), a);
  EXPECT_LT((motion.delta_v() - 0.5 * a).norm(), 1e-12);
  EXPECT_LT((motion.delta_p() - 0.125 * a).norm(), 1e-12);
}

TEST(Preintegration, BiasJacobianAgreesWithDifferences) {
  const ImuBias bias{{0.01, -0.02, 0.005}, {0.05, 0.02, -0.03}};
  const ImuPreintegration at = integrate(0.5, 0.01, bias);
  constexpr double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    ImuBias plus = bias, minus = bias;
    (k < 3 ? plus.gyro_radps[k] : plus.accel_mps2[k - 3]) += h;
    (k < 3 ? minus.gyro_radps[k] : minus.accel_mps2[k - 3]) -= h;
    const Eigen::Matrix<double, 9, 1> numeric =
        difference(integrate(0.5, 0.01, minus), integrate(0.5, 0.01, plus)) / (2 * h);
    EXPECT_LT((numeric - at.bias_jacobian().col(k)).norm(), 1e-6) << "column " << k;
  }
}

TEST(Preintegration, CorrectionForAnotherBiasIsFirstOrder) {
  const ImuBias bias{{0.002, -0.001, 0.003}, {0.02, 0.01, -0.01}};
  const ImuPreintegration corrected = integrate(0.5, 0.01, {}).corrected(bias);
  const ImuPreintegration direct = integrate(0.5, 0.01, bias);
  EXPECT_GT(difference(integrate(0.5, 0.01, {}), direct).norm(), 5e-3);
  EXPECT_LT(difference(corrected, direct).norm(), 2e-5);
}

TEST(Preintegration, CovarianceAgreesWithMonteCarlo) {
  const ImuCalibration imu;
  const double root_rate = 10.0;  // 100 Hz
  const ImuPreintegration truth = integrate(1.0, 0.01, {});
  Eigen::Matrix<double, 9, 9> sample = Eigen::Matrix<double, 9, 9>::Zero();
  constexpr int kRuns = 2000;
  for (uint64_t run = 0; run < kRuns; ++run) {
    const RandomStream stream(run, "imu");
    const auto noise = [&](int i) {
      Rates n;
      for (uint64_t k = 0; k < 3; ++k) {
        n.gyro_radps[static_cast<int>(k)] =
            imu.gyro_noise_radps_rthz * root_rate * stream.normal(static_cast<uint64_t>(i), k);
        n.accel_mps2[static_cast<int>(k)] =
            imu.accel_noise_mps2_rthz * root_rate * stream.normal(static_cast<uint64_t>(i), k + 3);
      }
      return n;
    };
    const auto e = difference(truth, integrate(1.0, 0.01, {}, noise));
    sample += e * e.transpose() / kRuns;
  }
  for (int k = 0; k < 9; ++k)
    EXPECT_NEAR(std::sqrt(sample(k, k) / truth.covariance()(k, k)), 1.0, 0.07) << "component " << k;
  // Velocity and position errors go together; so do rotation and velocity through gravity.
  for (const auto& [a, b] : {std::pair{3, 6}, {4, 7}, {5, 8}, {0, 4}, {1, 3}}) {
    const double scale = std::sqrt(truth.covariance()(a, a) * truth.covariance()(b, b));
    EXPECT_NEAR(sample(a, b) / scale, truth.covariance()(a, b) / scale, 0.08) << a << ", " << b;
  }
}

}  // namespace
}  // namespace vsslam

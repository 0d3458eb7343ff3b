// Known traps of the tool chain. A failure here means: do not trust the numbers of this build.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdint>

#include "core/rng.h"

namespace vsslam {
namespace {

// g++ 12.2 at -O3 with AVX miscompiles select() with a scalar branch for fixed matrices of 12 to 24 rows.
TEST(CompilerCanary, EigenSelectWithAScalarBranch) {
  using Matrix = Eigen::Matrix<double, 20, 60>;
  const RandomStream stream(1, "canary");
  Matrix a;
  for (int i = 0; i < a.size(); ++i) a.data()[i] = stream.normal(static_cast<uint64_t>(i));
  const Matrix selected = (a.array() > 0).select(0.0, a);
  for (int i = 0; i < a.size(); ++i)
    ASSERT_EQ(selected.data()[i], a.data()[i] > 0 ? 0.0 : a.data()[i]) << "cell " << i;
}

// With Eigen told that malloc's 16 bytes suffice, AVX kernels crash on the buffers of large products.
TEST(CompilerCanary, LargeEigenProductsDoNotCrash) {
  for (const int n : {120, 200, 400}) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n) * 2;
    const Eigen::MatrixXd b = Eigen::MatrixXd::Constant(n, n, 0.5);
    EXPECT_EQ((a * b).sum(), 1.0 * n * n);
    EXPECT_EQ((a.cast<float>() * b.cast<float>()).sum(), 1.0f * static_cast<float>(n * n));
    EXPECT_EQ(a.ldlt().solve(b).sum(), 0.25 * n * n);
  }
}

// Contraction of a * b + c into one rounding would change bytes between machines and optimisation levels.
TEST(CompilerCanary, ProductsAreRoundedBeforeSums) {
  volatile double a = 1.0 + 0x1p-30, b = 1.0 - 0x1p-30, c = -1.0;
  const double x = a, y = b, z = c;
  EXPECT_EQ(x * y + z, 0.0);  // exact: -2^-60, lost when the product is rounded first
}

}  // namespace
}  // namespace vsslam

#include "core/rng.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vsslam {
namespace {

TEST(Rng, QuantileInvertsTheDistributionFunction) {
  for (double p : {1e-300, 1e-20, 1e-6, 0.01, 0.07, 0.3, 0.5, 0.6, 0.93, 0.999}) {
    const double x = RandomStream::normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / p, 1.0, 1e-11) << p;
  }
  EXPECT_EQ(RandomStream::normal_quantile(0.5), 0.0);
}

TEST(Rng, MomentsOfNormal) {
  const RandomStream s(1, "range");
  double sum = 0, sum2 = 0, sum4 = 0, lag = 0, previous = 0;
  const int n = 400000;
  for (int i = 0; i < n; ++i) {
    const double x = s.normal(Time{i / 100}, i % 100);
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
    lag += x * previous;
    previous = x;
  }
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(sum2 / n, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(sum4 / n, 3, 5 * std::sqrt(96.0 / n));
  EXPECT_NEAR(lag / n, 0, 5 / std::sqrt(n));
}

TEST(Rng, UniformFillsItsBins) {
  const RandomStream s(7, "u");
  std::vector<int> bins(100);
  const int n = 1000000;
  for (int i = 0; i < n; ++i) ++bins[static_cast<size_t>(s.uniform(static_cast<uint64_t>(i) << 20, 3) * 100)];
  double chi2 = 0;
  for (int b : bins) chi2 += (b - n / 100.0) * (b - n / 100.0) / (n / 100.0);
  EXPECT_GT(chi2, 50);   // 99 degrees of freedom: 50 and 160 are beyond 4 sigma
  EXPECT_LT(chi2, 160);
}

TEST(Rng, StreamsDifferBySeedNameTimeAndIndex) {
  const RandomStream s(1, "a");
  EXPECT_EQ(s.bits(5, 6), RandomStream(1, "a").bits(5, 6));
  EXPECT_NE(s.bits(5, 6), RandomStream(2, "a").bits(5, 6));
  EXPECT_NE(s.bits(5, 6), RandomStream(1, "b").bits(5, 6));
  EXPECT_NE(s.bits(5, 6), s.bits(6, 5));
  EXPECT_NE(s.bits(5, 6), s.bits(5, 7));
}

}  // namespace
}  // namespace vsslam

#include "sensors/measurement/noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vsslam {
namespace {

TEST(NormalTable, InvertsTheDistributionFunction) {
  const NormalTable& table = NormalTable::instance();
  double worst = 0;
  for (uint64_t word = 0; word < (uint64_t{1} << 32); word += 65'521) {
    const double p = (static_cast<double>(word >> 1) + 0.5) * 0x1.0p-32;
    const double x = RandomStream::normal_quantile(p);
    const double expected = (word & 1) != 0 ? -x : x;
    worst = std::max(worst, std::abs(table(word << 32) - expected));
  }
  EXPECT_LT(worst, 2e-4);
  EXPECT_NEAR(table(0), -6.338, 1e-3);  // p = 2^-33
  EXPECT_NEAR(table(~uint64_t{0}), 0, 1e-6);
  EXPECT_NEAR(table(uint64_t{0xFFFFFFFE} << 32), 0, 1e-6);
  for (uint64_t half : {(1u << 27) - 1, 1u << 27, (1u << 22) - 1, 1u << 22})  // seams of the table
    EXPECT_NEAR(table(half << 33), RandomStream::normal_quantile(static_cast<double>(half) * 0x1.0p-32),
                2e-4);
}

TEST(NormalTable, SixteenAtOnceAreTheSame) {
  const RandomStream stream(4, "noise");
  double sum = 0, sum2 = 0;
  for (int64_t first = 0; first < 160'000; first += 16) {
    float out[16];
    NormalTable::instance().sixteen(stream, first, 9, out);
    for (int i = 0; i < 16; ++i) {
      EXPECT_EQ(out[i], NormalTable::instance()(stream.bits(static_cast<uint64_t>(first + i), 9)));
      sum += static_cast<double>(out[i]), sum2 += static_cast<double>(out[i]) * static_cast<double>(out[i]);
    }
  }
  EXPECT_NEAR(sum / 160e3, 0, 5 / 400.0);
  EXPECT_NEAR(sum2 / 160e3, 1, 5 * std::sqrt(2 / 160e3));
}

TEST(SlowNoise, HasUnitVarianceEverywhereAndIsContinuous) {
  const RandomStream stream(1, "slow");
  const SlowNoise noise(stream, 0.5);
  for (double phase : {0.0, 0.1, 0.25, 0.4}) {
    double sum2 = 0;
    for (int k = 0; k < 5000; ++k) sum2 += std::pow(noise.at(0.5 * k + phase, 3), 2);
    EXPECT_NEAR(sum2 / 5000, 1, 5 * std::sqrt(2 / 5000.0)) << phase;
  }
  EXPECT_NEAR(noise.at(1.5 - 1e-9), noise.at(1.5 + 1e-9), 1e-6);
  SlowNoise::Cache cache;
  for (double t : {0.1, 0.3, 0.7, 0.2}) EXPECT_EQ(noise.at(t, 0, cache), noise.at(t));
}

}  // namespace
}  // namespace vsslam

// Noise that changes slowly, and noise that is drawn by the million: both counter-based.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/rng.h"

namespace vsslam {

/// Unit-variance normal noise, continuous in time: independent normals at knots `interval` apart, blended
/// linearly and divided by the blend's own deviation. Any time may be asked for in any order.
class SlowNoise {
 public:
  SlowNoise(RandomStream stream, double interval_s) : stream_(stream), interval_s_(interval_s) {}
  double at(double time_s, uint64_t index = 0) const {
    const double knots = time_s / interval_s_;
    const double knot = std::floor(knots), w = knots - knot;
    const auto k = static_cast<uint64_t>(static_cast<int64_t>(knot));
    const double blend = (1 - w) * stream_.normal(k, index) + w * stream_.normal(k + 1, index);
    return blend / std::sqrt((1 - w) * (1 - w) + w * w);
  }

 private:
  RandomStream stream_;
  double interval_s_;
};

/// Standard normal from 64 uniform bits: the inverse distribution function, tabulated where it is smooth
/// (|x| < 2, error below 1e-4) and exact in the tails.
class NormalTable {
 public:
  static const NormalTable& instance();
  double operator()(uint64_t bits) const {
    const double p = (static_cast<double>(static_cast<int64_t>(bits >> 12)) + 0.5) * 0x1.0p-52;
    const double cell = p * kCells;
    const int i = static_cast<int>(cell);
    if (i < kFirst || i >= kCells - kFirst) return RandomStream::normal_quantile(p);
    const auto k = static_cast<size_t>(i);
    return quantile_[k] + (cell - i) * (quantile_[k + 1] - quantile_[k]);
  }

 private:
  NormalTable();
  static constexpr int kCells = 1024;
  static constexpr int kFirst = 24;  ///< p = 0.0234, x = -1.99
  std::array<double, kCells + 1> quantile_{};
};

}  // namespace vsslam

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
  /// The last knots asked for, to save drawing them again. Does not change results.
  struct Cache {
    bool valid = false;
    double knot = 0;
    double before = 0, after = 0;
  };
  double at(double time_s, uint64_t index = 0) const {
    Cache cache;
    return at(time_s, index, cache);
  }
  double at(double time_s, uint64_t index, Cache& cache) const {
    const double knots = time_s / interval_s_;
    const double knot = std::floor(knots), w = knots - knot;
    if (!cache.valid || cache.knot != knot) {
      const auto k = static_cast<uint64_t>(static_cast<int64_t>(knot));
      cache = {true, knot, stream_.normal(k, index), stream_.normal(k + 1, index)};
    }
    return ((1 - w) * cache.before + w * cache.after) / std::sqrt((1 - w) * (1 - w) + w * w);
  }

 private:
  RandomStream stream_;
  double interval_s_;
};

/// Standard normal from random bits, for noise drawn by the million: the inverse distribution function from
/// a table for |x| < 3.1 (error below 2e-4), exact beyond. Coarse cells over p in [0, 1/2], fine ones below
/// p = 1/32, mirrored for the other half.
class NormalTable {
 public:
  static const NormalTable& instance();
  /// Uses the upper 32 bits.
  float operator()(uint64_t bits) const {
    const auto word = static_cast<uint32_t>(bits >> 32);
    const auto half = static_cast<float>(static_cast<int32_t>(word >> 1));  // p = (half + 1/2) 2^-32
    const bool fine = half < 0x1.0p27f;
    const float cell = (half + 0.5f) * (fine ? 0x1.0p-18f : 0x1.0p-23f);
    const int k = static_cast<int>(cell);
    const size_t at = static_cast<size_t>(k) + (fine ? kCoarse + 1 : 0);
    float x = quantile_[at] + (cell - static_cast<float>(k)) * (quantile_[at + 1] - quantile_[at]);
    if (half < kExactBelow) x = exact(word >> 1);
    return (word & 1) != 0 ? -x : x;
  }

 private:
  NormalTable();
  static float exact(uint32_t half);
  static constexpr size_t kCoarse = 256, kFine = 512;
  static constexpr float kExactBelow = 0x1.0p22f;  ///< p = 1/1024
  std::array<float, kCoarse + 1 + kFine + 1> quantile_{};
};

}  // namespace vsslam

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
  float operator()(uint64_t bits) const;
  /// out[i] = (*this)(stream.bits(first + i, index)), sixteen at once.
  void sixteen(const RandomStream& stream, int64_t first, uint64_t index, float (&out)[16]) const;

 private:
  NormalTable();
  static float tail(int32_t half);
  void look_up(const int32_t (&words)[16], float (&out)[16]) const;
  static constexpr int kCoarse = 256, kFine = 512;
  static constexpr int32_t kExactBelow = 1 << 22;  ///< p = 1/1024
  /// Coarse knots, fine knots, and a spare one, because rounding may lift the last cell by one.
  std::array<float, static_cast<size_t>(kCoarse + 1 + kFine + 1 + 1)> quantile_{};
};

}  // namespace vsslam

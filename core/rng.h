// Counter-based random numbers: a value depends on a seed, a stream name, a time and an index, never on how
// many values were drawn before. Switching one noise source off leaves all others as they were, and any
// thread may draw any value.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/time.h"

namespace vsslam {

/// One named stream of random numbers. Copyable, immutable, 8 bytes.
class RandomStream {
 public:
  RandomStream(uint64_t seed, std::string_view name);

  /// 64 uniform bits for counter (a, b).
  uint64_t bits(uint64_t a, uint64_t b = 0) const {
    return mix(mix(key_ + a * 0x9E3779B97F4A7C15ull) ^ (b * 0xD1B54A32D192ED03ull + 0x8CB92BA72F3D8DD7ull));
  }
  /// Uniform in [0, 1).
  double uniform(uint64_t a, uint64_t b = 0) const {
    return static_cast<double>(bits(a, b) >> 11) * 0x1.0p-53;
  }
  /// Standard normal, by the inverse of its distribution function (one value per counter, no rejection).
  double normal(uint64_t a, uint64_t b = 0) const {
    return normal_quantile((static_cast<double>(bits(a, b) >> 12) + 0.5) * 0x1.0p-52);
  }
  double uniform(Time stamp, uint64_t index) const { return uniform(static_cast<uint64_t>(stamp.ns), index); }
  double normal(Time stamp, uint64_t index) const { return normal(static_cast<uint64_t>(stamp.ns), index); }

  /// Inverse of the standard normal distribution function for p in (0, 1).
  /// Wichura, "Algorithm AS 241", Applied Statistics 37 (1988), routine PPND16: relative error about 1e-16.
  static double normal_quantile(double p);

 private:
  static uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  uint64_t key_;
};

}  // namespace vsslam

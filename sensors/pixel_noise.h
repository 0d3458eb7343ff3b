// Normal noise for every pixel of every image: a function of seed, stream name, image and pixel, eight at a time.
#pragma once

#include <cstdint>

#include "core/rng.h"

namespace vsslam {

/// The normals of one image. A 32-bit counter is hashed twice under a 64-bit key; the hash goes through the inverse of
/// the normal distribution (M. Giles, "Approximating the erfinv function", GPU Computing Gems, 2011): relative error of
/// a normal below 1e-5, tails to 6.3 sigma.
class PixelNoise {
 public:
  static constexpr int kBlock = 64;
  PixelNoise(const RandomStream& stream, uint64_t image) {
    const uint64_t key = stream.bits(image);
    key_low_ = static_cast<uint32_t>(key), key_high_ = static_cast<uint32_t>(key >> 32);
  }
  /// Of the pixels first .. first + kBlock - 1.
  void block(uint32_t first, float (&normal)[kBlock]) const;

 private:
  uint32_t key_low_, key_high_;
};

}  // namespace vsslam

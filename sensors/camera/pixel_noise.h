// Normal noise for every pixel of every image: a function of seed, stream name, image and pixel, eight at a time.
#pragma once

#include <cstdint>

#include "core/rng.h"

namespace vsslam {

/// The normals of one image. A 32-bit counter is hashed twice under a 64-bit key; the sum of the hash's bytes is bent
/// into a normal: moments to the sixth within 1e-3 of the true ones, tails right to 5 sigma, none beyond 5.64, in steps
/// of 0.007.
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

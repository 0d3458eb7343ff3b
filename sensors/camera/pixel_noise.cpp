#include "sensors/camera/pixel_noise.h"

#include <immintrin.h>

namespace vsslam {

namespace {

// A bijection of 32 bits with good avalanche: shifts by half, odd factors.
__m256i scramble(__m256i x) {
  x = _mm256_xor_si256(x, _mm256_srli_epi32(x, 16));
  x = _mm256_mullo_epi32(x, _mm256_set1_epi32(0x7FEB352D));
  x = _mm256_xor_si256(x, _mm256_srli_epi32(x, 15));
  x = _mm256_mullo_epi32(x, _mm256_set1_epi32(static_cast<int32_t>(0x846CA68Bu)));
  return _mm256_xor_si256(x, _mm256_srli_epi32(x, 16));
}

// The sum of a word's four bytes, 0 .. 1020, is nearly normal. An odd polynomial makes it so: fitted by least squares
// to the mean of a normal within each of the 1021 shares of probability, weighted by their 0.3rd power, and scaled to
// variance 1.
constexpr float kMeanOfSum = 510, kSigmaOfSum = 147.80054f;  // sqrt(4 (256^2 - 1) / 12)
constexpr float kNormalOfSum[] = {2.488722035e-05f,  -5.946504129e-04f, 5.342982080e-03f,
                                  -2.002978035e-02f, 4.203592391e-02f,  9.492425082e-01f};

__m256 normal(__m256i word) {
  const __m256i pairs = _mm256_maddubs_epi16(word, _mm256_set1_epi8(1));
  const __m256 sum = _mm256_cvtepi32_ps(_mm256_madd_epi16(pairs, _mm256_set1_epi16(1)));
  const __m256 s =
      _mm256_mul_ps(_mm256_sub_ps(sum, _mm256_set1_ps(kMeanOfSum)), _mm256_set1_ps(1 / kSigmaOfSum));
  const __m256 s2 = _mm256_mul_ps(s, s);
  __m256 value = _mm256_set1_ps(kNormalOfSum[0]);
#pragma GCC unroll 5
  for (int i = 1; i < 6; ++i) value = _mm256_fmadd_ps(value, s2, _mm256_set1_ps(kNormalOfSum[i]));
  return _mm256_mul_ps(value, s);
}

}  // namespace

void PixelNoise::block(uint32_t first, float (&out)[kBlock]) const {
  const __m256i low = _mm256_set1_epi32(static_cast<int32_t>(key_low_));
  const __m256i high = _mm256_set1_epi32(static_cast<int32_t>(key_high_));
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  for (int i = 0; i < kBlock; i += 8) {
    const __m256i pixel =
        _mm256_add_epi32(_mm256_set1_epi32(static_cast<int32_t>(first + static_cast<uint32_t>(i))), lanes);
    const __m256i word = scramble(_mm256_add_epi32(scramble(_mm256_xor_si256(pixel, low)), high));
    _mm256_storeu_ps(out + i, normal(word));
  }
}

}  // namespace vsslam

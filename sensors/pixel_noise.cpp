#include "sensors/pixel_noise.h"

#include <immintrin.h>

namespace vsslam {

namespace {

__m256 set(float value) {
  return _mm256_set1_ps(value);
}

/// Coefficients from the highest power down.
template <int N>
__m256 polynomial(const float (&c)[N], __m256 x) {
  __m256 sum = set(c[0]);
  for (int i = 1; i < N; ++i) sum = _mm256_fmadd_ps(sum, x, set(c[i]));
  return sum;
}

// A bijection of 32 bits with good avalanche: shifts by half, odd factors.
__m256i scramble(__m256i x) {
  x = _mm256_xor_si256(x, _mm256_srli_epi32(x, 16));
  x = _mm256_mullo_epi32(x, _mm256_set1_epi32(0x7FEB352D));
  x = _mm256_xor_si256(x, _mm256_srli_epi32(x, 15));
  x = _mm256_mullo_epi32(x, _mm256_set1_epi32(static_cast<int32_t>(0x846CA68Bu)));
  return _mm256_xor_si256(x, _mm256_srli_epi32(x, 16));
}

// -log(x) for normal positive x: x = m 2^e with m within a factor of sqrt(2) of 1, log m = 2 atanh((m - 1) / (m + 1)).
__m256 minus_log(__m256 x) {
  const __m256i bits = _mm256_castps_si256(x);
  const __m256i above = _mm256_sub_epi32(bits, _mm256_set1_epi32(0x3F3504F3));  // sqrt(1/2)
  const __m256i e = _mm256_srai_epi32(above, 23);
  const __m256 m = _mm256_castsi256_ps(_mm256_sub_epi32(bits, _mm256_slli_epi32(e, 23)));
  const __m256 s = _mm256_div_ps(_mm256_sub_ps(m, set(1)), _mm256_add_ps(m, set(1)));
  constexpr float kAtanh[] = {-2.0f / 7, -2.0f / 5, -2.0f / 3, -2.0f};
  const __m256 minus_log_m = _mm256_mul_ps(s, polynomial(kAtanh, _mm256_mul_ps(s, s)));
  return _mm256_fnmadd_ps(_mm256_cvtepi32_ps(e), set(0.69314718f), minus_log_m);
}

// sqrt(2) erfinv(u) / u as a function of -log(1 - u^2): Giles' polynomials for the centre and the tails.
__m256 normal_over_u(__m256 w) {
  constexpr float kCentre[] = {2.81022636e-08f,  3.43273939e-07f, -3.5233877e-06f,
                               -4.39150654e-06f, 0.00021858087f,  -0.00125372503f,
                               -0.00417768164f,  0.246640727f,    1.50140941f};
  constexpr float kTail[] = {-0.000200214257f, 0.000100950558f, 0.00134934322f,
                             -0.00367342844f,  0.00573950773f,  -0.0076224613f,
                             0.00943887047f,   1.00167406f,     2.83297682f};
  __m256 value = polynomial(kCentre, _mm256_sub_ps(w, set(2.5f)));
  const __m256 in_tail = _mm256_cmp_ps(w, set(5), _CMP_GE_OQ);
  if (_mm256_movemask_ps(in_tail) != 0)
    value = _mm256_blendv_ps(value, polynomial(kTail, _mm256_sub_ps(_mm256_sqrt_ps(w), set(3))), in_tail);
  return _mm256_mul_ps(value, set(1.41421356f));
}

// The highest bit is the sign, the others are 2^32 p - 1/2, p < 1/2: u = 1 - 2 p, 1 - u^2 = 4 p (1 - p).
__m256 normal(__m256i word) {
  const __m256i half = _mm256_and_si256(word, _mm256_set1_epi32(0x7FFFFFFF));
  const __m256 p = _mm256_mul_ps(_mm256_add_ps(_mm256_cvtepi32_ps(half), set(0.5f)), set(0x1.0p-32f));
  const __m256 w = minus_log(_mm256_mul_ps(_mm256_mul_ps(set(4), p), _mm256_sub_ps(set(1), p)));
  const __m256 u = _mm256_fnmadd_ps(set(2), p, set(1));
  const __m256 sign = _mm256_castsi256_ps(_mm256_xor_si256(word, half));
  return _mm256_xor_ps(_mm256_mul_ps(u, normal_over_u(w)), sign);
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

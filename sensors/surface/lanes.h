// Eight floats or integers at once (AVX2), for code that treats a packet of 16 rays in two halves.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace vsslam::lanes {

inline constexpr int kLanes = 8;
using Floats = float __attribute__((vector_size(32)));
using Ints = int32_t __attribute__((vector_size(32)));
using Words = uint32_t __attribute__((vector_size(32)));

inline Floats all(float value) {
  return Floats{} + value;
}
inline Floats load(const float* from) {
  return (Floats)_mm256_loadu_ps(from);
}
inline Ints load(const int32_t* from) {
  return (Ints)_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}
inline void store(float* to, Floats x) {
  _mm256_storeu_ps(to, (__m256)x);
}
inline Floats floats(Ints x) {
  return __builtin_convertvector(x, Floats);
}
/// Towards zero.
inline Ints truncated(Floats x) {
  return __builtin_convertvector(x, Ints);
}
inline Floats floor(Floats x) {
  return (Floats)_mm256_floor_ps((__m256)x);
}
inline Floats min(Floats a, Floats b) {
  return (Floats)_mm256_min_ps((__m256)a, (__m256)b);
}
inline Floats max(Floats a, Floats b) {
  return (Floats)_mm256_max_ps((__m256)a, (__m256)b);
}
inline Floats sqrt(Floats x) {
  return (Floats)_mm256_sqrt_ps((__m256)x);
}
inline bool none(Ints mask) {
  return _mm256_testz_si256((__m256i)mask, (__m256i)mask);
}
/// Within 0.01, continuous; for positive normal numbers.
inline Floats rough_log2(Floats x) {
  const Ints bits = (Ints)x;
  const Floats mantissa = (Floats)((bits & 0x007FFFFF) | 0x3F800000);
  const Floats fraction = mantissa * (2.0f - mantissa * (1.0f / 3)) - 5.0f / 3;
  return floats((bits >> 23) - 127) + fraction;
}

inline Floats gather(const float* base, Ints index) {
  return (Floats)_mm256_i32gather_ps(base, (__m256i)index, 4);
}
/// base[index] and base[index + 1]. Eight loads of 64 bits: AVX2's own gathers take twice as long.
struct Pairs {
  Words first, second;
};
inline Pairs gather_pairs(const uint32_t* base, Ints index) {
  alignas(32) int32_t at[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(at), (__m256i)index);
  const auto two = [&](int i) {
    const __m128i pair = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + at[i]));
    return _mm_castps_pd(
        _mm_loadh_pi(_mm_castsi128_ps(pair), reinterpret_cast<const __m64*>(base + at[i + 1])));
  };
  const __m256 even = _mm256_castpd_ps(_mm256_set_m128d(two(4), two(0))),
               odd = _mm256_castpd_ps(_mm256_set_m128d(two(6), two(2)));
  return {(Words)_mm256_shuffle_ps(even, odd, 0x88), (Words)_mm256_shuffle_ps(even, odd, 0xDD)};
}

/// Turns eight rows of eight numbers, one row per lane, into eight vectors, one per column.
inline void transpose(const float* const (&rows)[8], int offset, Floats (&columns)[8]) {
  __m256 r[8], s[8];
  for (int i = 0; i < 8; ++i) r[i] = _mm256_loadu_ps(rows[i] + offset);
  for (int i = 0; i < 4; ++i) {
    s[2 * i] = _mm256_unpacklo_ps(r[2 * i], r[2 * i + 1]);
    s[2 * i + 1] = _mm256_unpackhi_ps(r[2 * i], r[2 * i + 1]);
  }
  for (int i = 0; i < 2; ++i) {
    r[4 * i] = _mm256_shuffle_ps(s[4 * i], s[4 * i + 2], 0x44);
    r[4 * i + 1] = _mm256_shuffle_ps(s[4 * i], s[4 * i + 2], 0xEE);
    r[4 * i + 2] = _mm256_shuffle_ps(s[4 * i + 1], s[4 * i + 3], 0x44);
    r[4 * i + 3] = _mm256_shuffle_ps(s[4 * i + 1], s[4 * i + 3], 0xEE);
  }
  for (int i = 0; i < 4; ++i) {
    columns[i] = (Floats)_mm256_permute2f128_ps(r[i], r[i + 4], 0x20);
    columns[i + 4] = (Floats)_mm256_permute2f128_ps(r[i], r[i + 4], 0x31);
  }
}

}  // namespace vsslam::lanes

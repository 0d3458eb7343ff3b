#include "sensors/measurement/noise.h"

#include <immintrin.h>

#include <algorithm>

namespace vsslam {

NormalTable::NormalTable() {
  // p = 0 is minus infinity; no cell that touches it is read.
  for (int i = 1; i <= kCoarse; ++i)
    quantile_[static_cast<size_t>(i)] =
        static_cast<float>(RandomStream::normal_quantile(static_cast<double>(i) / (2 * kCoarse)));
  for (int i = 1; i <= kFine; ++i)
    quantile_[static_cast<size_t>(kCoarse + 1 + i)] =
        static_cast<float>(RandomStream::normal_quantile(static_cast<double>(i) / (32 * kFine)));
}

const NormalTable& NormalTable::instance() {
  static const NormalTable table;
  return table;
}

float NormalTable::tail(int32_t half) {
  return static_cast<float>(RandomStream::normal_quantile((static_cast<double>(half) + 0.5) * 0x1.0p-32));
}

float NormalTable::operator()(uint64_t bits) const {
  float out[16];
  int32_t words[16];
  std::fill(std::begin(words), std::end(words), static_cast<int32_t>(bits >> 32));
  look_up(words, out);
  return out[0];
}

void NormalTable::sixteen(const RandomStream& stream, int64_t first, uint64_t index, float (&out)[16]) const {
  int32_t words[16];
  for (int i = 0; i < 16; ++i)
    words[i] = static_cast<int32_t>(stream.bits(static_cast<uint64_t>(first + i), index) >> 32);
  look_up(words, out);
}

// The lowest bit is the sign, the others are 2^32 p - 1/2, p < 1/2.
void NormalTable::look_up(const int32_t (&words)[16], float (&out)[16]) const {
  int tails = 0;
  for (int i = 0; i < 16; i += 8) {
    const __m256i word = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words + i));
    const __m256i half = _mm256_srli_epi32(word, 1);
    const __m256i fine = _mm256_cmpgt_epi32(_mm256_set1_epi32(1 << 27), half);
    const __m256 scale =
        _mm256_blendv_ps(_mm256_set1_ps(0x1.0p-23f), _mm256_set1_ps(0x1.0p-18f), _mm256_castsi256_ps(fine));
    const __m256 cell = _mm256_mul_ps(_mm256_add_ps(_mm256_cvtepi32_ps(half), _mm256_set1_ps(0.5f)), scale);
    const __m256i k = _mm256_cvttps_epi32(cell);
    const __m256i at = _mm256_add_epi32(k, _mm256_and_si256(fine, _mm256_set1_epi32(kCoarse + 1)));
    const __m256 below = _mm256_i32gather_ps(quantile_.data(), at, 4);
    const __m256 above = _mm256_i32gather_ps(quantile_.data() + 1, at, 4);
    const __m256 part = _mm256_sub_ps(cell, _mm256_cvtepi32_ps(k));
    const __m256 x = _mm256_add_ps(below, _mm256_mul_ps(part, _mm256_sub_ps(above, below)));
    const __m256i sign = _mm256_slli_epi32(word, 31);
    _mm256_storeu_ps(out + i, _mm256_xor_ps(x, _mm256_castsi256_ps(sign)));
    const __m256i tail_lanes = _mm256_cmpgt_epi32(_mm256_set1_epi32(kExactBelow), half);
    tails |= _mm256_movemask_epi8(tail_lanes);
  }
  if (tails == 0) return;
  for (int i = 0; i < 16; ++i) {
    const auto half = static_cast<int32_t>(static_cast<uint32_t>(words[i]) >> 1);
    if (half < kExactBelow) out[i] = (words[i] & 1) != 0 ? -tail(half) : tail(half);
  }
}

}  // namespace vsslam

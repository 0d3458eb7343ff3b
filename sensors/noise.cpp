#include "sensors/noise.h"

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
  const float* const quantile = quantile_.data();
  int32_t half[16];
  int tails = 0;
#pragma GCC ivdep
  for (int i = 0; i < 16; ++i) {
    half[i] = static_cast<int32_t>(static_cast<uint32_t>(words[i]) >> 1);
    const bool fine = half[i] < 1 << 27;
    const float cell = (static_cast<float>(half[i]) + 0.5f) * (fine ? 0x1.0p-18f : 0x1.0p-23f);
    const int k = static_cast<int>(cell);
    // Rounding may lift the last cell of each part by one; the parts end with a spare knot.
    const int at = std::min(k + (fine ? kCoarse + 1 : 0), kCoarse + kFine);
    const float below = quantile[at], above = quantile[at + 1];
    const float x = below + (cell - static_cast<float>(k)) * (above - below);
    out[i] = (words[i] & 1) != 0 ? -x : x;
    tails += half[i] < kExactBelow ? 1 : 0;
  }
  if (tails == 0) return;
  for (int i = 0; i < 16; ++i)
    if (half[i] < kExactBelow) out[i] = (words[i] & 1) != 0 ? -tail(half[i]) : tail(half[i]);
}

}  // namespace vsslam

#include "sensors/noise.h"

namespace vsslam {

NormalTable::NormalTable() {
  // p = 0 is minus infinity; no cell that touches it is read.
  for (size_t i = 1; i <= kCoarse; ++i)
    quantile_[i] = static_cast<float>(RandomStream::normal_quantile(static_cast<double>(i) / (2 * kCoarse)));
  for (size_t i = 1; i <= kFine; ++i)
    quantile_[kCoarse + 1 + i] =
        static_cast<float>(RandomStream::normal_quantile(static_cast<double>(i) / (32 * kFine)));
}

const NormalTable& NormalTable::instance() {
  static const NormalTable table;
  return table;
}

float NormalTable::exact(uint32_t half) {
  return static_cast<float>(RandomStream::normal_quantile((static_cast<double>(half) + 0.5) * 0x1.0p-32));
}

}  // namespace vsslam

#include "sensors/noise.h"

namespace vsslam {

NormalTable::NormalTable() {
  for (int i = 1; i < kCells; ++i)
    quantile_[static_cast<size_t>(i)] = RandomStream::normal_quantile(static_cast<double>(i) / kCells);
}

const NormalTable& NormalTable::instance() {
  static const NormalTable table;
  return table;
}

}  // namespace vsslam

#include "scenarios/datasets/export/sinks/point_truth_sink.h"

#include <fmt/format.h>

#include "core/files.h"

namespace vsslam {

std::filesystem::path PointTruthSink::file(int64_t index) const {
  return folder_ / fmt::format("{:06}.{}", index, ending_);
}

void PointTruthSink::write(const DatasetSample& sample) {
  const auto* lidar = std::get_if<LidarMeasurement>(&sample.measurement);
  if (lidar != nullptr && needs_scan(sample.index, {})) write_file(file(sample.index), encode_(lidar->truth));
}

}  // namespace vsslam

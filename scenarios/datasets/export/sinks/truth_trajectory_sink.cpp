#include "scenarios/datasets/export/sinks/truth_trajectory_sink.h"

#include <vector>

#include "scenarios/evaluation/trajectory_file.h"

namespace vsslam {

void TruthTrajectorySink::write(const DatasetSample& sample) {
  if (const auto* lidar = std::get_if<LidarMeasurement>(&sample.measurement))
    file_.write(
        format_tum(std::vector{StampedPose{dataset_time(lidar->scan.stamp), sample.base.T_world_base}}));
}

}  // namespace vsslam

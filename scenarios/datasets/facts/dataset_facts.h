// What every part of a dataset knows about the whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/calibration.h"
#include "scenarios/datasets/messages/sample_messages.h"
#include "scenarios/experiment/scenario.h"

namespace vsslam {

struct DatasetFacts {
  Scenario scenario;  ///< resolved, with the one seed that is used
  RigCalibration rig;
  MessageNames names;
  std::filesystem::path folder;
  bool has_camera() const { return scenario.rig.sensors.camera.enabled; }
};

/// What went into a dataset.
struct DatasetCounts {
  int64_t scans = 0, images = 0, imu = 0, wheels = 0;
  double duration_s = 0;
};

}  // namespace vsslam

// The sheet of a recording's rig: calibration and names of topics, as YAML. `export` writes one into every
// dataset (rig.yaml), `replay --rig` reads it; sheets of known robots are in rigs' library (NAME.yaml).
#pragma once

#include <string>

#include "core/calibration.h"
#include "core/config.h"

namespace vsslam {

/// Names of topics, or files; empty: guessed from the messages' types, or not there.
struct RecordingTopics {
  std::string lidar, imu, camera, wheels, truth;
  void fields(Fields& f);
};

struct RigSheet {
  RigCalibration calibration;
  RecordingTopics topics;
  void fields(Fields& f);
};

}  // namespace vsslam

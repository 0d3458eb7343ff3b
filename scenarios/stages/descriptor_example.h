// One decision of selective memory to look at: a key scan that was stored, the next one that was like it and was
// not, and the next that was stored again.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "slam/odometry.h"

namespace vsslam {

class DescriptorExample {
 public:
  /// Key scans in order, with what was decided about them. Keeps the first such three.
  void add(const OdometryScan& scan, const ScanReport& report);

  /// {scans: [{key, scan, stored, distance, heights_cm, points_lidar_cm}]}: distance to the first one's
  /// descriptor, heights of 20 rings x 60 sectors row by row, some points as x y z x y z ... in the lidar frame.
  /// The third may be missing; without a second one the text is empty.
  std::string json(double mount_height_m, const ScanContextConfig& config) const;

 private:
  struct Scan {
    int key = -1;
    int64_t scan = 0;
    bool stored = false;
    SharedCloud points_lidar;
  };
  std::array<std::optional<Scan>, 3> scans_;
};

}  // namespace vsslam

// What the estimator is handed of what the sensors measure: where a recording begins, which of the scans it has, and
// what driver and recorder make of their points. Neither the robot nor its sensors know of it.
#pragma once

#include "core/config.h"
#include "scenarios/experiment/scan_disturbances.h"
#include "sensors/measurement/samples.h"

namespace vsslam {

/// The `handed` section of a scenario.
struct HandedConfig {
  double from_s = 0;       ///< what is stamped before is withheld: the recording may begin in motion
  int every_nth_scan = 1;  ///< of those that the LiDAR delivers, its first one included
  ScanDisturbances scans;
  void fields(Fields& f);
  bool has_begun(Time stamp) const { return from_s == 0 || stamp.seconds() >= from_s; }
  /// `scan`: how many the LiDAR has delivered before.
  bool hands_scan(int64_t scan, Time stamp) const { return has_begun(stamp) && scan % every_nth_scan == 0; }
};

/// When a sample claims to be from.
Time stamp_of(const Measurement& measurement);

}  // namespace vsslam

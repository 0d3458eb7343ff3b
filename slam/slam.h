// The estimator, and the file to read first: an odometry (slam/odometry.h) and the mapping of one method
// (slam/mapping.h). Samples in, a trajectory, a map and a pose graph out.
//
// Frames: `base` is the robot, `lidar`, `imu`, `camera` its sensors; `odom` drifts but never jumps, `map` is
// corrected by loop closures and may jump. The estimator knows nothing else: no simulator, no truth.
#pragma once

#include "slam/mapping.h"
#include "slam/odometry.h"

namespace vsslam {

class Slam {
 public:
  Slam(const SlamConfig& config, const RigCalibration& rig, Method method, StageClock* clock = nullptr)
      : odometry_(config, rig, clock), mapping_(config, rig, method, clock) {}

  void add(const ImuSample& sample) { odometry_.add(sample); }
  void add(const WheelSample& sample) { odometry_.add(sample); }
  void add(const CameraFrame& image) { odometry_.add(image); }
  /// Samples of the other sensors up to scan.end should have been added before.
  ScanReport add(const LidarScan& scan) { return mapping_.add(odometry_.add(scan)); }
  /// Last optimisation; call once after the last sample.
  void finish() { mapping_.finish(); }

  const Odometry& odometry() const { return odometry_; }
  const Mapping& mapping() const { return mapping_; }

 private:
  Odometry odometry_;
  Mapping mapping_;
};

}  // namespace vsslam

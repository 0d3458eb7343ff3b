// The estimator, and the file to read first. Samples in, a trajectory, a map and a pose graph out.
//
// Frames: `base` is the robot, `lidar`, `imu`, `camera` its sensors; `odom` drifts but never jumps, `map` is
// corrected by loop closures and may jump. The estimator knows nothing else: no simulator, no truth.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/config.h"
#include "core/samples.h"
#include "core/stage_clock.h"
#include "slam/graph/pose_graph.h"
#include "slam/inertial/motion_prior.h"
#include "slam/key_scan.h"
#include "slam/lidar/lidar_odometry.h"
#include "slam/loop/loop_closer.h"

namespace vsslam {

/// Every setting of the stack: the `slam` section of a scenario.
struct SlamConfig {
  PriorKind prior = PriorKind::wheel_imu;
  InertialConfig inertial;
  LidarOdometryConfig odometry;
  LoopConfig loop;
  PoseGraphConfig graph;
  void fields(Fields& f);
};

/// What became of one scan.
struct ScanReport {
  Time stamp;
  int64_t scan = 0;         ///< 0, 1, 2, ... in order of arrival
  int key = -1;             ///< key scan id, -1: not a key scan
  SE3 T_map_base;           ///< belief right after this scan
  SE3 T_odom_base;          ///< odometry alone
  Information information;  ///< blocks of the point-to-plane problem at its last iteration
  int correspondences = 0;
  int iterations = 0;
  bool converged = false;
  int degenerate_directions = 0;  ///< of 6, held by the prior
  bool used_prior_only = false;   ///< too few correspondences: the prior alone gave the pose
};

class Slam {
 public:
  Slam(const SlamConfig& config, const RigCalibration& rig, Method method, StageClock* clock = nullptr);
  ~Slam();

  void add(const ImuSample& sample);
  void add(const WheelSample& sample);
  /// Samples of the other sensors up to scan.end should have been added before.
  ScanReport add(const LidarScan& scan);
  /// Last optimisation; call once after the last sample.
  void finish();

  /// Every scan so far, in the map frame after the last optimisation: each scan moves with its key scan.
  std::vector<StampedPose> trajectory_map_base() const;
  const std::vector<StampedPose>& trajectory_odom_base() const;
  const std::vector<KeyScan>& key_scans() const;
  const std::vector<LoopRecord>& loops() const;
  const LoopCloser& loop_closer() const;
  const PoseGraph& pose_graph() const;
  /// Points of all key scans in the map frame, one per voxel of `voxel_m`.
  Cloud map_cloud(double voxel_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

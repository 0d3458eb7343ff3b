// The back end of one method: key scans, loop closing, pose graph. It corrects the map; the odometry it is
// fed with never notices.
#pragma once

#include <memory>
#include <vector>

#include "core/calibration.h"
#include "core/stage_clock.h"
#include "slam/loop/loop_closer.h"
#include "slam/map/key_scan.h"
#include "slam/odometry.h"

namespace vsslam {

class Mapping {
 public:
  Mapping(const SlamConfig& config, const RigCalibration& rig, Method method, StageClock* clock = nullptr);
  ~Mapping();

  /// Scans in order, the first of them a key scan. The report with its key and map pose.
  ScanReport add(const OdometryScan& scan);
  /// Last optimisation; call once after the last scan.
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

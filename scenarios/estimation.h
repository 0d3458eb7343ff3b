// The estimating side of a run: one method, fed chunk by chunk, and what a score of it needs to remember.
#pragma once

#include <vector>

#include "scenarios/belief.h"
#include "scenarios/oracles/loop_truth.h"
#include "scenarios/sensing.h"
#include "slam/slam.h"

namespace vsslam {

/// What the estimator is told about the robot of a scenario.
RigCalibration calibration_of(const Scenario& scenario);

/// Not thread-safe; one per method and seed.
class Estimation {
 public:
  Estimation(const Scenario& scenario, Method method, StageClock* clock);

  /// Feeds a chunk; returns the beliefs of its scans.
  std::vector<Belief> add(const Chunk& chunk);
  void finish();

  Method method() const { return method_; }
  const Slam& slam() const { return slam_; }
  const std::vector<ScanReport>& reports() const { return reports_; }
  const std::vector<StampedPose>& truth_world_base() const { return truth_world_base_; }
  const std::vector<DegeneracyTruth>& degeneracy_truth() const { return degeneracy_truth_; }
  const std::vector<KeyScanTruth>& key_scan_truth() const { return key_scan_truth_; }

 private:
  Belief add(const LidarMeasurement& measurement, const ScanTruth& truth);

  Method method_;
  StageClock* clock_;
  Slam slam_;
  std::vector<ScanReport> reports_;
  std::vector<StampedPose> truth_world_base_;
  std::vector<DegeneracyTruth> degeneracy_truth_;
  std::vector<KeyScanTruth> key_scan_truth_;
  SE3 T_world_map_;
};

}  // namespace vsslam

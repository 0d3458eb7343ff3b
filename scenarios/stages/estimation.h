// The estimating side of a run: one odometry for all methods, one mapping for each, fed chunk by chunk, and
// what a score of them needs to remember.
#pragma once

#include <memory>
#include <vector>

#include "scenarios/health/doctor.h"
#include "scenarios/oracles/loop_truth.h"
#include "scenarios/stages/belief.h"
#include "scenarios/stages/contact_sheet.h"
#include "scenarios/stages/descriptor_example.h"
#include "scenarios/stages/sensing.h"
#include "slam/loop/scan_context.h"
#include "slam/mapping.h"
#include "slam/odometry.h"

namespace vsslam {

/// What the estimator is told about the robot of a scenario.
RigCalibration calibration_of(const Scenario& scenario);

/// What an estimator is made of.
struct EstimatorSetup {
  SlamConfig slam;
  RigCalibration rig;
  double map_voxel_m = 0.1;  ///< of map.ply
};

/// A chunk with what the odometry made of it.
struct OdometryChunk {
  std::shared_ptr<const Chunk> chunk;
  std::vector<OdometryScan> scans;  ///< one per LidarMeasurement, same order
  std::vector<int64_t> elapsed_ns;  ///< wall clock of each; not for results
};

/// Not thread-safe; one per seed.
class OdometryRun {
 public:
  OdometryRun(const EstimatorSetup& setup, StageClock* clock);

  OdometryChunk add(std::shared_ptr<const Chunk> chunk);
  const ContactSheet& pictures() const { return pictures_; }
  /// So far.
  Health health(const SourceHealth& source) const { return doctor_.health(odometry_.health(), source); }
  /// Of the key scans, which are the same for all methods. Empty without truth.
  const std::vector<KeyScanTruth>& key_scan_truth() const { return key_scan_truth_; }
  const std::vector<ScanContext>& true_descriptors() const { return true_descriptors_; }

 private:
  void remember_key(const LidarMeasurement& measurement, const SE3& T_world_base);

  StageClock* clock_;
  ScanContextConfig scan_context_;
  double mount_height_m_;
  Odometry odometry_;
  SensorDoctor doctor_;
  ContactSheet pictures_;
  std::vector<KeyScanTruth> key_scan_truth_;
  std::vector<ScanContext> true_descriptors_;
};

/// Not thread-safe; one per method and seed.
class MappingRun {
 public:
  MappingRun(const EstimatorSetup& setup, Method method, StageClock* clock);

  /// Returns the beliefs of the chunk's scans.
  std::vector<Belief> add(const OdometryChunk& chunk);
  void finish();

  Method method() const { return method_; }
  const Mapping& mapping() const { return mapping_; }
  const std::vector<ScanReport>& reports() const { return reports_; }
  /// Of the scans; empty if the chunks have no truth.
  const std::vector<StampedPose>& truth_world_base() const { return truth_world_base_; }
  /// The prior's own way, where it sees; else empty.
  const std::vector<StampedPose>& vio_start_base() const { return vio_start_base_; }
  int restarts() const { return restarts_; }
  int64_t images() const { return images_; }
  /// Of the scans; empty if the chunks have no truth.
  const std::vector<DegeneracyTruth>& degeneracy_truth() const { return degeneracy_truth_; }
  const DescriptorExample& descriptor_example() const { return descriptor_example_; }

 private:
  Belief add(const OdometryScan& scan);
  void remember_truth(Time stamp, const ScanTruth& truth);

  Method method_;
  StageClock* clock_;
  Mapping mapping_;
  std::vector<ScanReport> reports_;
  std::vector<StampedPose> truth_world_base_, vio_start_base_;
  int restarts_ = 0;
  int64_t images_ = 0;
  std::vector<DegeneracyTruth> degeneracy_truth_;
  DescriptorExample descriptor_example_;
  SE3 T_world_map_;
};

}  // namespace vsslam

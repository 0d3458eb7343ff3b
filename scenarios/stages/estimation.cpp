#include "scenarios/stages/estimation.h"

#include <utility>

#include "scenarios/oracles/aliases.h"

namespace vsslam {

namespace {

int64_t now_ns(StageClock* clock) {
  return clock ? clock->now_ns() : 0;
}

}  // namespace

RigCalibration calibration_of(const Scenario& scenario) {
  return scenario.rig.calibration(scenario.robot.wheel_radius_m, effective_track_m(scenario.robot),
                                  base_height_m(scenario.robot));
}

OdometryRun::OdometryRun(const EstimatorSetup& setup, StageClock* clock)
    : clock_(clock),
      scan_context_(setup.slam.loop.scan_context),
      mount_height_m_(setup.rig.lidar.mount_height_m),
      odometry_(setup.slam, setup.rig, clock),
      doctor_(setup.rig) {}

OdometryChunk OdometryRun::add(std::shared_ptr<const Chunk> chunk) {
  OdometryChunk result{.chunk = std::move(chunk), .scans = {}, .elapsed_ns = {}};
  for (const Measurement& measurement : result.chunk->measurements) {
    if (const auto* imu = std::get_if<ImuMeasurement>(&measurement)) {
      odometry_.add(imu->sample);
      doctor_.add(imu->sample);
    } else if (const auto* wheels = std::get_if<WheelMeasurement>(&measurement)) {
      odometry_.add(wheels->sample);
      doctor_.add(wheels->sample);
    } else if (const auto* camera = std::get_if<CameraMeasurement>(&measurement)) {
      odometry_.add(camera->frame);
      pictures_.add(camera->frame);
      doctor_.add(camera->frame);
    } else if (const auto* lidar = std::get_if<LidarMeasurement>(&measurement)) {
      const int64_t start_ns = now_ns(clock_);
      result.scans.push_back(odometry_.add(lidar->scan));
      result.elapsed_ns.push_back(now_ns(clock_) - start_ns);
      doctor_.add(lidar->scan, result.scans.back().report);
      if (result.scans.back().is_key && result.chunk->has_truth())
        remember_key(*lidar, result.chunk->scans[result.scans.size() - 1].T_world_base);
    }
  }
  return result;
}

void OdometryRun::remember_key(const LidarMeasurement& measurement, const SE3& T_world_base) {
  const StageTimer timer(clock_, "truth");
  const int key = static_cast<int>(key_scan_truth_.size());
  key_scan_truth_.push_back(
      vsslam::key_scan_truth(key, measurement, T_world_base, LoopTruthOptions{}.max_points));
  true_descriptors_.push_back(true_descriptor(measurement, mount_height_m_, scan_context_));
}

MappingRun::MappingRun(const EstimatorSetup& setup, Method method, StageClock* clock)
    : method_(method), clock_(clock), mapping_(setup.slam, setup.rig, method, clock) {}

std::vector<Belief> MappingRun::add(const OdometryChunk& chunk) {
  for (const Measurement& measurement : chunk.chunk->measurements)
    if (std::holds_alternative<CameraMeasurement>(measurement)) ++images_;
  std::vector<Belief> beliefs;
  for (size_t i = 0; i < chunk.scans.size(); ++i) {
    const int64_t start_ns = now_ns(clock_);
    if (chunk.chunk->has_truth()) remember_truth(chunk.scans[i].report.stamp, chunk.chunk->scans[i]);
    beliefs.push_back(add(chunk.scans[i]));
    if (clock_) clock_->record("slam_scan", chunk.elapsed_ns[i] + now_ns(clock_) - start_ns);
  }
  return beliefs;
}

void MappingRun::remember_truth(Time stamp, const ScanTruth& truth) {
  // The map's origin is the base at the first scan, with z up: what a robot that knows its parking place knows.
  if (reports_.empty())
    T_world_map_ = SE3::from_rpy({0, 0, truth.T_world_base.rpy().z()}, truth.T_world_base.translation);
  truth_world_base_.push_back({stamp, truth.T_world_base});
  degeneracy_truth_.push_back(truth.degeneracy);
}

Belief MappingRun::add(const OdometryScan& scan) {
  reports_.push_back(mapping_.add(scan));
  const ScanReport& report = reports_.back();
  if (scan.visual) {
    vio_start_base_.push_back({report.stamp, scan.visual->T_start_base});
    restarts_ = scan.visual->restarts;
  }
  if (scan.is_key) descriptor_example_.add(scan, report);
  return {scan.end, report.stamp, T_world_map_ * report.T_map_base};
}

void MappingRun::finish() {
  StageTimer timer(clock_, "slam_finish");
  mapping_.finish();
}

}  // namespace vsslam

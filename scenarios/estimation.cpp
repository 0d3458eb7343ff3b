#include "scenarios/estimation.h"

namespace vsslam {

RigCalibration calibration_of(const Scenario& scenario) {
  return scenario.rig.calibration(scenario.robot.wheel_radius_m, effective_track_m(scenario.robot),
                                  base_height_m(scenario.robot));
}

Estimation::Estimation(const Scenario& scenario, Method method, StageClock* clock)
    : method_(method), clock_(clock), slam_(scenario.slam, calibration_of(scenario), method, clock) {}

std::vector<Belief> Estimation::add(const Chunk& chunk) {
  std::vector<Belief> beliefs;
  for (const Measurement& measurement : chunk.measurements) {
    if (const auto* imu = std::get_if<ImuMeasurement>(&measurement)) {
      slam_.add(imu->sample);
    } else if (const auto* wheels = std::get_if<WheelMeasurement>(&measurement)) {
      slam_.add(wheels->sample);
    } else if (const auto* lidar = std::get_if<LidarMeasurement>(&measurement)) {
      beliefs.push_back(add(*lidar, chunk.scans[beliefs.size()]));
    }
  }
  return beliefs;
}

Belief Estimation::add(const LidarMeasurement& measurement, const ScanTruth& truth) {
  // The map's origin is the base at the first scan, with z up: what a robot that knows its parking place knows.
  if (reports_.empty())
    T_world_map_ = SE3::from_rpy({0, 0, truth.T_world_base.rpy().z()}, truth.T_world_base.translation);
  {
    StageTimer timer(clock_, "slam_scan");
    reports_.push_back(slam_.add(measurement.scan));
  }
  const ScanReport& report = reports_.back();
  truth_world_base_.push_back({measurement.scan.stamp, truth.T_world_base});
  degeneracy_truth_.push_back(truth.degeneracy);
  if (report.key >= 0)
    key_scan_truth_.push_back(
        vsslam::key_scan_truth(report.key, measurement, truth.T_world_base, LoopTruthOptions{}.max_points));
  return {measurement.scan.end, report.stamp, T_world_map_ * report.T_map_base};
}

void Estimation::finish() {
  StageTimer timer(clock_, "slam_finish");
  slam_.finish();
}

}  // namespace vsslam

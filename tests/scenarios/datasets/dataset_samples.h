// Measurements made by hand, for sinks of datasets.
#pragma once

#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"
#include "scenarios/stages/estimation.h"

namespace vsslam {

/// A scenario whose sensors all sit askew, so that a transform written the wrong way round shows.
inline DatasetFacts askew_facts(const std::filesystem::path& folder, bool camera = true) {
  DatasetFacts facts;
  facts.scenario.name = "askew";
  RigConfig& rig = facts.scenario.rig;
  rig.mounts.lidar = {{0.1, -0.2, 0.45}, {3, -4, 20}};
  rig.mounts.imu = {{-0.05, 0.02, 0.12}, {-2, 5, 95}};
  rig.mounts.camera = {{0.32, 0.04, 0.30}, {-95, 4, -80}};
  rig.sensors.camera.enabled = camera;
  rig.sensors.camera.k1 = -0.01;
  rig.sensors.camera.p2 = 0.002;
  facts.rig = calibration_of(facts.scenario);
  facts.folder = folder;
  return facts;
}

inline DatasetSample imu_sample(double t_s, const Vec3& gyro_radps = Vec3::Zero(),
                                const Vec3& accel_mps2 = {0, 0, 9.8}) {
  ImuMeasurement m;
  m.sample.stamp = m.true_stamp = Time::from_seconds(t_s);
  m.sample.gyro_radps = gyro_radps;
  m.sample.accel_mps2 = accel_mps2;
  return {.measurement = m, .end = m.true_stamp};
}

inline DatasetSample scan_sample(int64_t index, double t_s, const SE3& T_world_base = {},
                                 std::vector<LidarPoint> points = {{1, 2, 3, 51, 4, 0.01f}}) {
  LidarMeasurement m;
  m.scan.stamp = m.true_stamp = Time::from_seconds(t_s);
  m.scan.end = m.scan.stamp + Duration{99'000'000};
  m.truth.resize(points.size());
  m.scan.points = std::move(points);
  DatasetSample sample{.measurement = std::move(m), .end = Time::from_seconds(t_s) + Duration{99'000'000}};
  sample.base.T_world_base = T_world_base;
  sample.index = index;
  return sample;
}

inline DatasetSample image_sample(int64_t index, double t_s, const std::string& png) {
  CameraMeasurement m;
  m.frame.stamp = m.true_stamp = Time::from_seconds(t_s);
  m.end = m.true_stamp + Duration{1'000'000};
  m.frame.width_px = m.frame.height_px = 4;
  m.frame.grey.assign(16, 7);
  DatasetSample sample{.measurement = m, .end = m.end};
  sample.index = index;
  sample.png = png;
  return sample;
}

}  // namespace vsslam

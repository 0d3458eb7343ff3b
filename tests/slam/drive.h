// Drives the estimator through a scene and compares it with the motion.
#pragma once

#include <algorithm>

#include "slam/slam.h"
#include "tests/slam/analytic_scene.h"

namespace vsslam::testing_scene {

struct DriveOptions {
  double duration_s = 20;
  Noise noise;
  double wheel_scale = 1.0;  ///< what the wheels claim over what they roll
  SlamConfig config;
  Method method = Method::lvi_sam_no_loop;
  /// Called before a sample is handed over; false drops it. Kind: 'i', 'w' or 'l'.
  std::function<bool(char, Time)> keep = [](char, Time) { return true; };
  std::function<void(ImuSample&)> corrupt_imu = [](ImuSample&) {};
  StageClock* clock = nullptr;
};

struct Driven {
  std::vector<ScanReport> reports;
  std::vector<SE3> T_odom_base_true;  ///< at the stamps of the reports
  double path_m = 0;
  double position_rmse_m = 0, worst_m = 0, worst_rotation_rad = 0;
  std::vector<KeyScan> keys;
  std::vector<StampedPose> trajectory_map_base;
};

inline Driven drive(const Scene& scene, const Motion& motion, const DriveOptions& options) {
  const RigCalibration calibration = rig();
  Slam slam(options.config, calibration, options.method, options.clock);
  Wheels wheels(calibration, options.wheel_scale);
  Driven driven;
  const SE3 T_odom_scene = SE3(motion(0.0).rotation, motion(0.0).translation).inverse();
  for (int64_t ms = 0; ms <= static_cast<int64_t>(options.duration_s * 1e3); ms += 10) {
    const Time now{ms * 1'000'000};
    ImuSample imu = imu_sample(motion, calibration, now, options.noise);
    options.corrupt_imu(imu);
    if (options.keep('i', now)) slam.add(imu);
    const WheelSample turn = wheels.advance(motion, now);
    if (ms % 20 == 0 && options.keep('w', now)) slam.add(turn);
    if (ms % 100 != 0 || ms == 0) continue;
    const Time begin = now - Duration{100'000'000};
    if (!options.keep('l', begin)) continue;
    driven.reports.push_back(slam.add(scan(scene, motion, calibration, begin, options.noise)));
    driven.T_odom_base_true.push_back(T_odom_scene * motion(begin.seconds()));
  }
  slam.finish();
  for (size_t i = 0; i < driven.reports.size(); ++i) {
    const SE3 error = driven.T_odom_base_true[i].inverse() * driven.reports[i].T_odom_base;
    driven.position_rmse_m += error.translation.squaredNorm() / static_cast<double>(driven.reports.size());
    driven.worst_m = std::max(driven.worst_m, error.translation.norm());
    driven.worst_rotation_rad = std::max(driven.worst_rotation_rad, error.angle());
    if (i > 0)
      driven.path_m +=
          (driven.T_odom_base_true[i].translation - driven.T_odom_base_true[i - 1].translation).norm();
  }
  driven.position_rmse_m = std::sqrt(driven.position_rmse_m);
  driven.keys = slam.mapping().key_scans();
  driven.trajectory_map_base = slam.mapping().trajectory_map_base();
  return driven;
}

}  // namespace vsslam::testing_scene

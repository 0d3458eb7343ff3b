// FAST-LIO 2 (Xu et al., T-RO 2022), github.com/hku-mars/FAST_LIO, ROS 1. Keys and conventions: its config/velodyne.yaml,
// src/IMU_Processing.hpp.
#include <fmt/format.h>

#include <cmath>

#include "scenarios/datasets/systems/configuration_text.h"
#include "scenarios/datasets/systems/target_configurations.h"

namespace vsslam {

namespace {

std::string covariance(double density, double rate_hz) {
  return real_text(std::pow(per_sample(density, rate_hz), 2));
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  const ImuCalibration& imu = facts.rig.imu;
  const SE3 T_imu_lidar = imu.T_base_imu.inverse() * facts.rig.lidar.T_base_lidar;
  const std::string text = fmt::format(
      "# FAST-LIO's parameters for this dataset: numbers of the simulated rig.\n"
      "common:\n    lid_topic: \"{}\"\n    imu_topic: \"{}\"\n    time_sync_en: false\n"
      "    time_offset_lidar_to_imu: 0.0\n\n"
      "preprocess:\n    lidar_type: 2           # Velodyne\n    scan_line: {}\n    scan_rate: {}\n"
      "    timestamp_unit: 0       # the field `time` is in seconds\n    blind: {}\n\n"
      "mapping:\n"
      "    # Discrete: variances of a sample, density^2 * rate; (m/s^2)^2, (rad/s)^2, and the walks' "
      "likewise.\n"
      "    # Its authors ship 0.1, 0.1, 0.0001, 0.0001, much more than any IMU of this kind has.\n"
      "    acc_cov: {}\n    gyr_cov: {}\n    b_acc_cov: {}\n    b_gyr_cov: {}\n"
      "    fov_degree: 180\n    det_range: {}\n    extrinsic_est_en: false\n"
      "    # T_imu_lidar: LiDAR coordinates to IMU coordinates, exact.\n"
      "    extrinsic_T: [{}]\n    extrinsic_R: [{}]\n\n"
      "publish:\n    path_en: true\n    scan_publish_en: true\n    dense_publish_en: true\n"
      "    scan_bodyframe_pub_en: true\n\npcd_save:\n    pcd_save_en: false\n    interval: -1\n",
      facts.names.points, facts.names.imu, facts.rig.lidar.rings, facts.scenario.rig.sensors.lidar.rate_hz,
      real_text(facts.rig.lidar.min_range_m), covariance(imu.accel_noise_mps2_rthz, imu.rate_hz),
      covariance(imu.gyro_noise_radps_rthz, imu.rate_hz),
      covariance(imu.accel_bias_walk_mps3_rthz, imu.rate_hz),
      covariance(imu.gyro_bias_walk_radps2_rthz, imu.rate_hz), real_text(facts.rig.lidar.max_range_m),
      vector_text(T_imu_lidar.translation), matrix_text(T_imu_lidar.matrix3(), "                  "));
  return {{"fast_lio/velodyne.yaml", text}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "Put `fast_lio/velodyne.yaml` in the place of `config/velodyne.yaml` of the package `fast_lio` and "
      "start\n\n"
      "    roslaunch fast_lio mapping_velodyne.launch\n"
      "    rosbag play {}.bag\n\n"
      "The robot rests at the start, as the initialisation of the IMU wants it. The pose is the IMU's; "
      "`truth.tum` is "
      "the base's, `T_base_imu` in `rig.yaml`. If it diverges on a rig with a very good IMU, the authors' "
      "larger "
      "covariances are more forgiving.\n",
      facts.scenario.name);
}

}  // namespace

TargetSystem fast_lio() {
  return {"fast-lio", "FAST-LIO", DatasetFormat::bag, false, false, {}, configuration, instructions};
}

}  // namespace vsslam

#include "scenarios/datasets/systems/loam_settings.h"

#include <fmt/format.h>

#include "scenarios/datasets/systems/configuration_text.h"

namespace vsslam {

// Their code turns the IMU's vectors into the LiDAR's axes by extrinsicRot, its orientation by what extrinsicRPY says,
// from the right, and then sees the IMU at extrinsicTrans in the LiDAR frame.
std::string loam_sensor_settings(const DatasetFacts& facts, ExtrinsicRpy rpy) {
  const ImuCalibration& imu = facts.rig.imu;
  const SE3 T_lidar_imu = facts.rig.lidar.T_base_lidar.inverse() * imu.T_base_imu;
  const bool inverse = rpy == ExtrinsicRpy::lidar_to_imu;
  return fmt::format(
      "  N_SCAN: {}\n  Horizon_SCAN: 1800\n  timeField: \"time\"\n  downsampleRate: 1\n\n"
      "  # Continuous-time densities: rad/s/sqrt(Hz), m/s^2/sqrt(Hz); walks rad/s^2/sqrt(Hz), "
      "m/s^3/sqrt(Hz).\n"
      "  imuAccNoise: {}\n  imuGyrNoise: {}\n  imuAccBiasN: {}\n  imuGyrBiasN: {}\n  imuGravity: {}\n\n"
      "  # T_lidar_imu: extrinsicTrans is the IMU's origin in the LiDAR frame (m), extrinsicRot turns IMU "
      "vectors into\n"
      "  # LiDAR axes, and so {} extrinsicRPY.\n"
      "  extrinsicTrans: [{}]\n  extrinsicRot: [{}]\n  extrinsicRPY: [{}]\n\n",
      facts.rig.lidar.rings, real_text(imu.accel_noise_mps2_rthz), real_text(imu.gyro_noise_radps_rthz),
      real_text(imu.accel_bias_walk_mps3_rthz), real_text(imu.gyro_bias_walk_radps2_rthz),
      real_text(imu.gravity_mps2), inverse ? "does the inverse of" : "does",
      vector_text(T_lidar_imu.translation), matrix_text(T_lidar_imu.matrix3(), "                 "),
      matrix_text((inverse ? T_lidar_imu.inverse() : T_lidar_imu).matrix3(), "                 "));
}

std::string loam_mapping_settings(const DatasetFacts& facts) {
  const double leaf_m = leaf_size_m(facts);
  return "  edgeThreshold: 1.0\n  surfThreshold: 0.1\n  edgeFeatureMinValidNum: 10\n  "
         "surfFeatureMinValidNum: 100\n\n"
         "  # Filter sizes in m: 0.2, 0.1, 0.2 indoors, 0.4, 0.2, 0.4 outdoors.\n" +
         fmt::format("  odometrySurfLeafSize: {}\n  mappingCornerLeafSize: {}\n  mappingSurfLeafSize: {}\n\n",
                     real_text(leaf_m), real_text(leaf_m / 2), real_text(leaf_m)) +
         "  z_tollerance: 1000\n  rotation_tollerance: 1000\n\n"
         "  numberOfCores: 4\n  mappingProcessInterval: 0.15\n\n"
         "  surroundingkeyframeAddingDistThreshold: 1.0\n  surroundingkeyframeAddingAngleThreshold: 0.2\n"
         "  surroundingKeyframeDensity: 2.0\n  surroundingKeyframeSearchRadius: 50.0\n\n"
         "  loopClosureEnableFlag: true\n  loopClosureFrequency: 1.0\n  surroundingKeyframeSize: 50\n"
         "  historyKeyframeSearchRadius: 15.0\n  historyKeyframeSearchTimeDiff: 30.0\n"
         "  historyKeyframeSearchNum: 25\n  historyKeyframeFitnessScore: 0.3\n\n"
         "  globalMapVisualizationSearchRadius: 1000.0\n  globalMapVisualizationPoseDensity: 10.0\n"
         "  globalMapVisualizationLeafSize: 1.0\n";
}

}  // namespace vsslam

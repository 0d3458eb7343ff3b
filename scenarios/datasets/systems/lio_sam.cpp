// LIO-SAM (Shan et al., IROS 2020), github.com/TixiaoShan/LIO-SAM, ROS 1. Keys and conventions: its config/params.yaml and
// include/utility.h.
#include <fmt/format.h>

#include "scenarios/datasets/systems/configuration_text.h"
#include "scenarios/datasets/systems/loam_settings.h"
#include "scenarios/datasets/systems/target_configurations.h"

namespace vsslam {

namespace {

MessageNames names() {
  MessageNames names;
  names.points = "/points_raw";
  names.imu = "/imu_raw";
  names.lidar_frame = "base_link";  // what LIO-SAM calls the LiDAR's frame unless told otherwise
  return names;
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  const std::string text =
      fmt::format(
          "# LIO-SAM's parameters for this dataset: numbers of the simulated rig, settings as its authors "
          "ship them.\n"
          "lio_sam:\n\n"
          "  pointCloudTopic: \"{}\"\n  imuTopic: \"{}\"\n  odomTopic: \"odometry/imu\"\n  gpsTopic: "
          "\"odometry/gps\"\n\n"
          "  # The map is of the LiDAR: its pose, not the chassis', is what comes out.\n"
          "  lidarFrame: \"{}\"\n  baselinkFrame: \"{}\"\n  odometryFrame: \"odom\"\n  mapFrame: \"map\"\n\n"
          "  useImuHeadingInitialization: true\n  useGpsElevation: false\n  gpsCovThreshold: 2.0\n"
          "  poseCovThreshold: 25.0\n\n"
          "  savePCD: false\n  savePCDDirectory: \"/Downloads/LOAM/\"\n\n  sensor: velodyne\n",
          facts.names.points, facts.names.imu, facts.names.lidar_frame, facts.names.lidar_frame) +
      loam_sensor_settings(facts, ExtrinsicRpy::imu_to_lidar) +
      fmt::format("  lidarMinRange: {}\n  lidarMaxRange: {}\n  imuRPYWeight: 0.01\n\n",
                  real_text(facts.rig.lidar.min_range_m), real_text(facts.rig.lidar.max_range_m)) +
      loam_mapping_settings(facts);
  return {{"lio_sam/params.yaml", text}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "Put `lio_sam/params.yaml` in the place of `config/params.yaml` of the package `lio_sam` and start\n\n"
      "    roslaunch lio_sam run.launch\n"
      "    rosbag play {}.bag\n\n"
      "The last two scans are never processed: LIO-SAM waits for two more. Its pose is the LiDAR's; "
      "`truth.tum` is the "
      "base's, `T_base_lidar` in `rig.yaml`.\n",
      facts.scenario.name);
}

}  // namespace

TargetSystem lio_sam() {
  return {"lio-sam", "LIO-SAM", DatasetFormat::bag, false, true, names(), configuration, instructions};
}

}  // namespace vsslam

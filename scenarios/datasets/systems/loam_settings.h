// What the configurations of LIO-SAM and of LVI-SAM's LiDAR half have in common.
#pragma once

#include <string>

#include "scenarios/datasets/facts/dataset_facts.h"

namespace vsslam {

/// What the orientation of the IMU's device is multiplied by from the right: LVI-SAM takes `extrinsicRPY` as it is,
/// LIO-SAM (ROS 1, since its pull request 339) inverts it first.
enum class ExtrinsicRpy { lidar_to_imu, imu_to_lidar };

/// LiDAR's size, IMU's noise, extrinsics; YAML lines indented by two.
std::string loam_sensor_settings(const DatasetFacts& facts, ExtrinsicRpy rpy);
/// Features, filters and map, as the authors ship them, with their filter sizes for indoors or outdoors; loop closing on.
std::string loam_mapping_settings(const DatasetFacts& facts);

}  // namespace vsslam

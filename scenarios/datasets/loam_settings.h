// What the configurations of LIO-SAM and of LVI-SAM's LiDAR half have in common.
#pragma once

#include <string>

#include "scenarios/datasets/dataset_facts.h"

namespace vsslam {

/// LiDAR's size, IMU's noise, extrinsics; YAML lines indented by two.
std::string loam_sensor_settings(const DatasetFacts& facts);
/// Features, filters and map, as the authors ship them (indoor filter sizes); loop closing on.
std::string loam_mapping_settings();

}  // namespace vsslam

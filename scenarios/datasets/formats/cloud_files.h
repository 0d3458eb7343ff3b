// Clouds as files of their own. Bytes are little-endian; points keep the order of firing.
#pragma once

#include <span>
#include <string>

#include "core/samples.h"
#include "sensors/measurement/samples.h"

namespace vsslam {

/// Binary PCD 0.7: x y z intensity float32, ring uint16, time float32 (s after the stamp); 22 bytes a point.
std::string pcd_of_scan(const LidarScan& scan);
/// Binary PLY with the same properties.
std::string ply_of_scan(const LidarScan& scan);
/// KITTI's velodyne/*.bin: x y z reflectance float32; reflectance is intensity / 255.
std::string kitti_of_scan(const LidarScan& scan);
/// Binary PCD of each point's truth: x y z normal_x normal_y normal_z range cos_incidence float32, object triangle
/// material uint32. Position and normal are noise-free and undistorted, in the LiDAR frame at the scan's true stamp.
std::string pcd_of_truth(std::span<const PointTruth> truth);
/// Binary PCD of the noise-free, undistorted twins: x y z float32.
std::string pcd_of_twins(std::span<const PointTruth> truth);
/// SemanticKITTI's .label: one uint32 a point, material in the lower 16 bits, object in the upper.
std::string labels_of(std::span<const PointTruth> truth);

}  // namespace vsslam

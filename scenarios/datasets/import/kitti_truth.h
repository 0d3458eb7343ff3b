// The truth of a KITTI odometry folder: its poses are those of camera 0.
#pragma once

#include <filesystem>

#include "scenarios/evaluation/trajectory_file.h"

namespace vsslam {

/// T_world_base at the scans, the world being where camera 0 began. `poses` has T_world_camera of each scan; the folder
/// has times.txt, and calib.txt with T_camera_lidar as `Tr`. Throws InputError.
PoseTrajectory read_kitti_truth(const std::filesystem::path& poses, const std::filesystem::path& folder,
                                const SE3& T_base_lidar);

}  // namespace vsslam

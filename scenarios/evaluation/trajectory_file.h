// Trajectories as text files that other tools read and write.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/se3.h"

namespace vsslam {

using PoseTrajectory = std::vector<StampedPose>;

/// TUM: `t x y z qx qy qz qw`, eight columns, stamps ascending, `#` starts a comment line.
/// Throws InputError with file:line: wrong column count, not a number, NaN, quaternion far from unit length,
/// stamp not after the one before, no pose at all.
PoseTrajectory read_tum(const std::filesystem::path& path);
PoseTrajectory parse_tum(std::string_view text, const std::string& name);
/// Nine decimals for everything; the quaternion with qw >= 0.
std::string format_tum(std::span<const StampedPose> trajectory);
void write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory);

/// KITTI odometry: the upper 3 x 4 of each pose, twelve numbers a line. Stamps (s) come from `times`, one a
/// line, of the same length; without it pose n has the stamp n * 0.1 s.
PoseTrajectory read_kitti(const std::filesystem::path& path, const std::filesystem::path& times = {});
PoseTrajectory parse_kitti(std::string_view text, const std::string& name);
/// Whether the first line that is no comment has twelve columns.
bool is_kitti(const std::filesystem::path& path);
void write_kitti(const std::filesystem::path& path, std::span<const StampedPose> trajectory);
void write_kitti_times(const std::filesystem::path& path, std::span<const StampedPose> trajectory);

/// TUM or KITTI, told apart by the number of columns of the first line that is no comment. A KITTI file takes
/// its stamps from times.txt beside it if that exists.
PoseTrajectory read_trajectory(const std::filesystem::path& path);

}  // namespace vsslam

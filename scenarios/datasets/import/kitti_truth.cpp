#include "scenarios/datasets/import/kitti_truth.h"

#include <fmt/format.h>

#include <sstream>

#include "core/errors.h"
#include "core/files.h"

namespace vsslam {

namespace {

SE3 read_mount(const std::filesystem::path& calibration) {
  constexpr std::string_view kKey = "Tr:";
  std::istringstream text(read_file(calibration));
  int number = 1;
  for (std::string line; std::getline(text, line); ++number)
    if (line.starts_with(kKey))
      return parse_kitti(line.substr(kKey.size()), fmt::format("{}:{}: Tr", calibration.string(), number))
          .front()
          .pose;
  throw InputError(fmt::format("{}: expected a line `Tr:` with the LiDAR's pose in camera 0, twelve numbers",
                               calibration.string()));
}

}  // namespace

PoseTrajectory read_kitti_truth(const std::filesystem::path& poses, const std::filesystem::path& folder,
                                const SE3& T_base_lidar) {
  const SE3 T_camera_base = read_mount(folder / "calib.txt") * T_base_lidar.inverse();
  PoseTrajectory truth = read_kitti(poses, folder / "times.txt");
  for (StampedPose& sample : truth) sample.pose = sample.pose * T_camera_base;
  return truth;
}

}  // namespace vsslam

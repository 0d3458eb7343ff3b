// Drives of real LiDARs through the door of `vsslam replay`, by the LiDAR alone, against their published poses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "tests/scenarios/command_line.h"
#include "tests/scratch.h"
#include "tests/shared_data.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

class RealData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::is_directory(shared_folder()))
      GTEST_SKIP() << "no folder " << shared_folder() << " (VSSLAM_SHARED names another)";
  }

  static fs::path recording(const std::string& name) { return shared_folder() / "data" / "real" / name; }

  /// metrics.json; empty if it did not come to that.
  static nlohmann::json replay(const fs::path& folder, const std::vector<std::string>& options = {}) {
    const fs::path out = scratch_folder() / "runs";
    std::vector<std::string> arguments = {"replay", folder.string(), "--out", out.string()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = call(arguments);
    const fs::path result = out / folder.filename() / "vs-slam" / "replay";
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (!fs::exists(result / "metrics.json")) return {};
    const PoseTrajectory estimate = read_tum(result / "estimate.tum");
    const nlohmann::json metrics = nlohmann::json::parse(read_file(result / "metrics.json"));
    fmt::print("{}: {} scans, moved by {:.3f} m, path of the truth {} m, error at the end {} m\n",
               folder.filename().string(), estimate.size(),
               (estimate.front().pose.inverse() * estimate.back().pose).translation.norm(),
               metrics.value("path_length_m", nlohmann::json()).dump(),
               metrics.value("end_error_m", nlohmann::json()).dump());
    return metrics;
  }
};

/// A folder of its own: the scans and poses of the sequence, with `Tr` of its published calib.txt and the car's sheet.
fs::path kitti_with_calibration(const fs::path& sequence) {
  const fs::path folder = scratch_folder() / sequence.filename();
  fs::create_directories(folder);
  fs::create_directory_symlink(fs::absolute(sequence / "velodyne"), folder / "velodyne");
  for (const char* file : {"times.txt", "poses.txt"}) write_file(folder / file, read_file(sequence / file));
  write_file(folder / "calib.txt",
             "Tr: 4.276802385584e-04 -9.999672484946e-01 -8.084491683471e-03 -1.198459927713e-02 "
             "-7.210626507497e-03 8.081198471645e-03 -9.999413164504e-01 -5.403984729748e-02 "
             "9.999738645903e-01 4.859485810390e-04 -7.206933692422e-03 -2.921968648686e-01\n");
  write_file(
      folder / "rig.yaml",
      "lidar: {rings: 64, mount_height_m: 1.73, min_range_m: 2, max_range_m: 100, range_sigma_m: 0.02}\n");
  return folder;
}

// Six scans of an HDL-64E, corrected for the car's motion. The published poses move 0.86 m a scan; the scans do not agree
// with them. Searched by brute force (x, y and yaw of each pair, mean squared distance to the nearest point above the ground,
// cut off at 0.15 m), they move by 0.683, 0.696, 0.717, 0.732 and 0.746 m, with a mean that is 0.4 to 0.6 of that at the
// published motion; generalised ICP (PCL 1.13), begun at the published motion, agrees within 4 cm a pair.
TEST_F(RealData, KittisCarIsWhereItDroveFromTheFirstScanOn) {
  const fs::path sequence = recording("kitti_00");
  for (const char* file : {"times.txt", "poses.txt", "velodyne/000005.bin"})
    ASSERT_TRUE(fs::exists(sequence / file)) << sequence / file;
  const nlohmann::json metrics = replay(kitti_with_calibration(sequence), {"--undistorted"});
  ASSERT_TRUE(metrics.contains("end_error_m"));
  EXPECT_EQ(metrics["scans"], 6);
  constexpr double kFound_m = 3.574, kPublished_m = 4.30;
  EXPECT_NEAR(metrics["path_length_m"], kPublished_m, 0.01);
  EXPECT_NEAR(metrics["end_error_m"], kPublished_m - kFound_m, 0.1);
}

// Key scans of an Ouster OS1-64, 1 to 2 m and 0.2 to 8 s apart, without rings and times.
TEST_F(RealData, KeyScansFarApartInSpaceAndTimeAreFollowed) {
  const fs::path drive = recording("seosan01");
  for (const char* file : {"rig.yaml", "truth.tum", "pcd/times.csv", "pcd/000020.pcd"})
    ASSERT_TRUE(fs::exists(drive / file)) << drive / file;
  const nlohmann::json metrics = replay(drive);
  ASSERT_TRUE(metrics.contains("end_error_m"));
  EXPECT_EQ(metrics["scans"], 21);
  EXPECT_NEAR(metrics["path_length_m"], 25.57, 0.01);
  EXPECT_LT(metrics["end_error_m"], 0.5);
}

}  // namespace
}  // namespace vsslam

// Recordings that went wrong, replayed: what is mended is said, and the trajectory is as if nothing had been wrong.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "tests/scenarios/command_line.h"
#include "tests/scratch.h"
#include "tests/shared_data.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Replayed {
  Outcome outcome;
  nlohmann::json metrics, recording;

  double ate_m() const { return metrics.value("ate_rmse_m", 1e9); }
  int64_t used(const char* sensor) const { return recording["samples"][sensor]["used"]; }
};

Replayed replayed(const std::string& name, const std::vector<std::string>& more = {}) {
  const fs::path folder = shared_case(name);
  std::vector<std::string> arguments = {
      "replay", (folder / "drive.bag").string(),     "--rig", (folder / "rig.yaml").string(), "--name", name,
      "--out",  (scratch_folder() / "runs").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Replayed result{call(arguments), {}, {}};
  EXPECT_EQ(result.outcome.code, 0) << result.outcome.err;
  if (result.outcome.code != 0) return result;
  const fs::path run = scratch_folder() / "runs" / name / "vs-slam" / "replay";
  result.metrics = nlohmann::json::parse(read_file(run / "metrics.json"));
  result.recording = nlohmann::json::parse(read_file(run / "recording.json"));
  std::printf("%s: ATE %.5f m, %lld scans, notes %s\n", name.c_str(), result.ate_m(),
              static_cast<long long>(result.used("lidar")), result.recording["notes"].dump().c_str());
  return result;
}

TEST(ReplayShared, ControlIsAsItWas) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed control = replayed("control");
  EXPECT_EQ(control.used("lidar"), 50);
  EXPECT_EQ(control.used("imu"), 501);
  EXPECT_EQ(control.recording["notes"].size(), 2u);
  EXPECT_LT(control.ate_m(), 0.01);
}

TEST(ReplayShared, AClockOfItsOwnIsMovedToTheOthers) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed own = replayed("lidar_on_own_clock");
  EXPECT_EQ(own.used("lidar"), 50);
  EXPECT_EQ(own.recording["samples"]["lidar"]["moved_to_clock"], 50);
  EXPECT_LT(own.ate_m(), 0.02);
  EXPECT_THAT(own.outcome.err, HasSubstr("clock of lidar (/velodyne_points)"));
  EXPECT_THAT(own.outcome.err, HasSubstr("that of imu (/imu/data)"));
}

TEST(ReplayShared, AClockThatIsSetBackIsFollowed) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed set = replayed("clock_set_back_one_hour");
  EXPECT_EQ(set.used("lidar"), 50);
  EXPECT_LT(set.ate_m(), 0.01);
  EXPECT_THAT(set.outcome.err, HasSubstr("set back by 3600.000 s"));
}

TEST(ReplayShared, LateSamplesAreWaitedFor) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed late = replayed("lidar_recorded_2s_late");
  EXPECT_EQ(late.used("lidar"), 50);
  EXPECT_LT(late.ate_m(), 0.01);
  EXPECT_THAT(late.outcome.err, HasSubstr("lidar (/velodyne_points): arrives up to"));
}

TEST(ReplayShared, TenBitsOfSixteenAreAsGoodAsTheUpperOnes) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed ten = replayed("mono16_ten_bits"), control = replayed("mono16_ten_bits_control");
  EXPECT_THAT(ten.outcome.err, HasSubstr("the lower 10 are used"));
  EXPECT_EQ(ten.metrics["vio_ate_rmse_m"], control.metrics["vio_ate_rmse_m"]);
  EXPECT_EQ(ten.metrics["ate_rmse_m"], control.metrics["ate_rmse_m"]);
}

TEST(ReplayShared, PointsOfASnapshotHaveNoTimes) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed snapshot = replayed("snapshot_times_zero");
  EXPECT_LT(snapshot.ate_m(), 0.01);
  EXPECT_THAT(snapshot.outcome.err, HasSubstr("the points' times are all the same"));
}

TEST(ReplayShared, TimesOfASimulatedClockAreNotOffsets) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed simulated = replayed("simulated_clock_absolute_times");
  EXPECT_EQ(simulated.used("lidar"), 50);
  EXPECT_EQ(simulated.used("imu"), 501);
  EXPECT_LT(simulated.ate_m(), 0.01);
}

TEST(ReplayShared, OneBrokenPictureIsLeftOut) {
  VSSLAM_NEEDS_SHARED_CASES();
  const Replayed broken = replayed("one_broken_jpeg", {"--topic", "camera=/camera/image_raw/compressed"});
  EXPECT_EQ(broken.recording["samples"]["camera"]["dropped_unreadable"], 1);
  EXPECT_GT(broken.used("camera"), 20);
  EXPECT_LT(broken.ate_m(), 0.02);
}

}  // namespace
}  // namespace vsslam

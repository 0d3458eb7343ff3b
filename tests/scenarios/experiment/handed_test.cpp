#include "scenarios/experiment/handed.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "scenarios/experiment/scenario_world.h"
#include "scenarios/stages/driving.h"
#include "scenarios/stages/sensing.h"
#include "tests/scenarios/command_line.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

Scenario scenario(const std::vector<Override>& more = {}) {
  std::vector<Override> overrides = {Override::parse("max_duration_s=5"),
                                     Override::parse("world.room.textures=false"),
                                     Override::parse("drive.steps.0.rest.duration_s=0.5")};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scenario("quick_room", overrides);
}

Chunk handed(const Scenario& scenario) {
  ScenarioWorld place(scenario);
  Driving driving(scenario, place.world(), nullptr);
  Sensing sensing(scenario, place.world(), 1, nullptr);
  Chunk all;
  while (!driving.ended()) {
    Chunk chunk = sensing.next(driving.next(std::nullopt, sensing.needed_from()));
    std::move(chunk.measurements.begin(), chunk.measurements.end(), std::back_inserter(all.measurements));
    all.scans.insert(all.scans.end(), chunk.scans.begin(), chunk.scans.end());
  }
  return all;
}

std::vector<const LidarMeasurement*> scans_of(const Chunk& chunk) {
  std::vector<const LidarMeasurement*> scans;
  for (const Measurement& m : chunk.measurements)
    if (const auto* lidar = std::get_if<LidarMeasurement>(&m)) scans.push_back(lidar);
  return scans;
}

TEST(Handed, SamplesBeforeAreWithheldAndEveryNthScanIsAsItWas) {
  const Chunk whole = handed(scenario()),
              part = handed(scenario({{"handed.from_s", "1.5"}, {"handed.every_nth_scan", "5"}}));
  for (const Measurement& m : part.measurements) EXPECT_GE(stamp_of(m).seconds(), 1.5);
  EXPECT_EQ(std::count_if(whole.measurements.begin(), whole.measurements.end(),
                          [](const Measurement& m) {
                            return std::holds_alternative<ImuMeasurement>(m) && stamp_of(m).seconds() >= 1.5;
                          }),
            std::count_if(part.measurements.begin(), part.measurements.end(),
                          [](const Measurement& m) { return std::holds_alternative<ImuMeasurement>(m); }));
  const auto all = scans_of(whole), some = scans_of(part);
  ASSERT_GT(some.size(), 5u);
  ASSERT_EQ(part.scans.size(), some.size());
  size_t found = 0;
  for (size_t i = 0; i < all.size(); i += 5) {
    if (all[i]->scan.stamp.seconds() < 1.5) continue;
    ASSERT_LT(found, some.size());
    EXPECT_EQ(some[found]->scan.stamp, all[i]->scan.stamp);
    EXPECT_EQ(part.scans[found].T_world_base.translation, whole.scans[i].T_world_base.translation);
    ASSERT_EQ(some[found]->scan.points.size(), all[i]->scan.points.size());
    EXPECT_EQ(some[found]->scan.points.back().x, all[i]->scan.points.back().x);
    ++found;
  }
  EXPECT_EQ(found, some.size());
}

// Every disturbance at once. Which points still show the world does not depend on how the oracles look at them.
TEST(Handed, DisturbedScansKeepTheTruthOfTheirPlaceAndOfWhatTheyShow) {
  const Chunk clean = handed(scenario()),
              disturbed = handed(scenario({{"handed.scans.time_jitter_us", "60"},
                                           {"handed.scans.second_return_share", "0.1"},
                                           {"handed.scans.rain_share", "0.02"},
                                           {"handed.scans.mast.radius_m", "0.05"},
                                           {"handed.scans.rings", "none"}}));
  ASSERT_EQ(clean.scans.size(), disturbed.scans.size());
  const auto scans = scans_of(disturbed), clean_scans = scans_of(clean);
  for (size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(clean.scans[i].T_world_base.translation, disturbed.scans[i].T_world_base.translation);
    EXPECT_GT(scans[i]->scan.points.size(), clean_scans[i]->scan.points.size());
    EXPECT_LT(scans[i]->truth.size(), clean_scans[i]->truth.size());
    EXPECT_GT(scans[i]->truth.size(), clean_scans[i]->truth.size() * 9 / 10);
  }
}

// The map begins at the first scan handed, wherever the robot was then; one thread or two make no difference.
TEST(Handed, ALateStartIsScoredFromItsFirstScan) {
  const fs::path file = scratch_folder() / "late.yaml";
  write_file(file, save_config(scenario({{"name", "late"},
                                         {"handed.from_s", "2"},
                                         {"handed.every_nth_scan", "2"},
                                         {"handed.scans.time_jitter_us", "20"},
                                         {"handed.scans.second_return_share", "0.05"}})));
  std::string estimates[2];
  for (const int threads : {1, 2}) {
    const fs::path out = scratch_folder() / std::to_string(threads),
                   result = out / "late" / "vs-slam" / "seed_1";
    const Outcome outcome =
        call({"run", file.string(), "--out", out.string(), "--quiet", "--threads", std::to_string(threads)});
    ASSERT_TRUE(fs::exists(result / "truth.tum")) << outcome.err;
    const PoseTrajectory truth = read_tum(result / "truth.tum"), estimate = read_tum(result / "estimate.tum");
    ASSERT_EQ(truth.size(), estimate.size());
    EXPECT_GE(truth.front().stamp.seconds(), 2);
    EXPECT_NEAR(seconds_between(truth[0].stamp, truth[1].stamp), 0.2, 0.001);
    EXPECT_LT(estimate.front().pose.translation.norm(), 1e-9);
    const nlohmann::json metrics = nlohmann::json::parse(read_file(result / "metrics.json"));
    EXPECT_EQ(metrics["scans"], truth.size());
    EXPECT_GT(metrics["path_length_m"], 1.5);
    EXPECT_TRUE(metrics["ate_rmse_m"].is_number());
    estimates[threads - 1] = read_file(result / "estimate.tum");
  }
  EXPECT_TRUE(estimates[0] == estimates[1]);
}

}  // namespace
}  // namespace vsslam

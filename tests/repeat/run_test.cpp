// Same bytes twice, and for any number of threads.
#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/files.h"
#include "core/ordered_parallel.h"
#include "scenarios/run/runner.h"
#include "scenarios/stages/wall_clock.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

Scenario short_scenario(const std::string& setting = "map_voxel_m=0.2") {
  return load_scenario("quick_room",
                       {{"max_duration_s", "4"}, {"textures", "false"}, Override::parse(setting)});
}

fs::path run_into(const std::string& name, Scenario scenario, int threads) {
  const fs::path out = scratch_folder() / name;
  fs::remove_all(out);
  set_thread_count(threads);
  Runner runner(scenario, {.out = out, .threads = threads});
  std::ostringstream quiet;
  WallClock clock;
  Progress progress(Progress::Style::none, quiet, clock, "");
  runner.run(std::atomic<bool>(false), progress);
  EXPECT_EQ(runner.finished().size(), resolve_methods(scenario.methods).size() * scenario.seeds.size());
  return out;
}

std::string without_timing_panel(std::string html) {
  const std::string begin = "<!-- timing begin -->", end = "<!-- timing end -->";
  const size_t from = html.find(begin), to = html.find(end);
  EXPECT_NE(from, std::string::npos);
  EXPECT_NE(to, std::string::npos);
  return html.erase(from, to - from);
}

// Path inside the folder -> content, without what tells the time.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().filename() == "timing.json") continue;
    std::string bytes = read_file(entry.path());
    if (entry.path().filename() == "report.html") bytes = without_timing_panel(bytes);
    files[fs::relative(entry.path(), folder).string()] = bytes;
  }
  return files;
}

void expect_same(const fs::path& a, const fs::path& b) {
  const auto files_a = contents(a), files_b = contents(b);
  ASSERT_GE(files_a.size(), 10u);
  ASSERT_EQ(files_a.size(), files_b.size());
  for (const auto& [name, bytes] : files_a) {
    ASSERT_TRUE(files_b.contains(name)) << name;
    EXPECT_TRUE(files_b.at(name) == bytes) << name << " differs";
  }
}

TEST(Repeat, SameBytesForOneAndTwoThreadsAndAllMethods) {
  Scenario scenario = short_scenario();
  scenario.methods = {"all"};
  const fs::path one = run_into("repeat_1", scenario, 1);
  expect_same(one, run_into("repeat_2", scenario, 2));
  expect_same(one, run_into("repeat_again", scenario, 1));
}

TEST(Repeat, ClosedLoopToo) {
  Scenario scenario = short_scenario("closed_loop=true");
  expect_same(run_into("closed_1", scenario, 1), run_into("closed_2", scenario, 2));
}

// Light maps, images, features and the window. What the camera alone makes of the way is within a percent.
TEST(Repeat, CameraAndVisualInertialOdometryToo) {
  const Scenario scenario = load_scenario("quick_room_vio", {{"max_duration_s", "6"}, {"map_voxel_m", "0.2"}});
  const fs::path one = run_into("camera_1", scenario, 1);
  expect_same(one, run_into("camera_2", scenario, 2));
  const fs::path folder = one / "quick_room_vio" / "vs-slam" / "seed_1";
  EXPECT_TRUE(fs::exists(folder / "vio.tum"));
  const auto metrics = nlohmann::json::parse(read_file(folder / "metrics.json"));
  EXPECT_GT(metrics["images"].get<int>(), 150);
  EXPECT_EQ(metrics["restarts"].get<int>(), 0);
  EXPECT_LT(metrics["vio_ate_rmse_m"].get<double>(), 0.01 * metrics["path_length_m"].get<double>());
}

TEST(Repeat, SavedScenarioGivesTheSameRun) {
  Scenario scenario = short_scenario();
  scenario.seeds = {1, 2};
  const fs::path both = run_into("saved_both", scenario, 2);
  const fs::path folder = both / "quick_room" / "vs-slam" / "seed_2";
  const fs::path again = run_into("saved_again", load_scenario((folder / "scenario.yaml").string()), 1);
  expect_same(folder, again / "quick_room" / "vs-slam" / "seed_2");
}

TEST(Repeat, AnotherSeedIsAnotherRun) {
  Scenario scenario = short_scenario();
  scenario.seeds = {1, 2};
  const fs::path out = run_into("seeds", scenario, 2) / "quick_room" / "vs-slam";
  EXPECT_NE(read_file(out / "seed_1" / "estimate.tum"), read_file(out / "seed_2" / "estimate.tum"));
}

}  // namespace
}  // namespace vsslam

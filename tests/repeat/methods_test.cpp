// Methods that must agree with one another, on one drive: all get the same key scans and the same graph.
#include <gtest/gtest.h>

#include <atomic>
#include <sstream>

#include "core/files.h"
#include "core/ordered_parallel.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/run/runner.h"
#include "scenarios/stages/wall_clock.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

// vs-slam takes every scene for similar to itself, so that it neither stores nor searches.
class Methods : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Scenario scenario =
        load_scenario("quick_room", {{"textures", "false"},
                                     {"slam.loop.vs_slam.memory.alpha_t_th", "0"},
                                     {"methods", "[lvi-sam-no-loop, sc-lvi-sam, vs-slam-no-st, vs-slam]"}});
    set_thread_count(2);
    Runner runner(scenario, {.out = scratch_folder(), .threads = 2});
    std::ostringstream quiet;
    WallClock clock;
    Progress progress(Progress::Style::none, quiet, clock, "");
    runner.run(std::atomic<bool>(false), progress);
  }
  static fs::path folder(const std::string& method) {
    return scratch_folder() / "quick_room" / method / "seed_1";
  }
  static std::string text(const std::string& method, const std::string& file) {
    return read_file(folder(method) / file);
  }
};

TEST_F(Methods, VsSlamThatStoresAndSearchesNothingIsNoLoopClosing) {
  for (const char* file :
       {"estimate.tum", "odometry.tum", "pose_graph.g2o", "map.ply", "loops.csv", "descriptors.csv"})
    EXPECT_TRUE(text("vs-slam", file) == text("lvi-sam-no-loop", file)) << file;
  EXPECT_NE(text("vs-slam-no-st", "pose_graph.g2o"), text("lvi-sam-no-loop", "pose_graph.g2o"));
}

TEST_F(Methods, ScLviSamAndVsSlamWithoutSelectionStoreTheSameKeyScans) {
  const CsvTable a = CsvTable::read(folder("sc-lvi-sam") / "descriptors.csv"),
                 b = CsvTable::read(folder("vs-slam-no-st") / "descriptors.csv");
  ASSERT_GT(a.rows(), 20u);
  ASSERT_EQ(a.rows(), b.rows());
  for (size_t row = 0; row < a.rows(); ++row) {
    EXPECT_EQ(a.integer(row, "key"), b.integer(row, "key"));
    EXPECT_EQ(a.integer(row, "scan"), b.integer(row, "scan"));
  }
}

}  // namespace
}  // namespace vsslam

#include "scenarios/suite/suite_offsets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/errors.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "tests/scenarios/suite/suite_in_scratch.h"

namespace vsslam {
namespace {

// Key scan 0 looks along +y. The others show it again: 1 m, 0.2 m and 3.9 m to the side.
PoseTrajectory truth() {
  const auto at = [](int second, double x_m, double y_m, double yaw_rad) {
    return StampedPose{Time{second * 1'000'000'000ll}, SE3::from_rpy({0, 0, yaw_rad}, {x_m, y_m, 0.1})};
  };
  return {at(0, 0, 0, std::numbers::pi / 2), at(1, 1, 3, 0), at(2, 7, 7, 1), at(3, -0.2, 3, 2),
          at(4, -3.9, 0, 3)};
}
constexpr const char* kScans = "key,revisit_of,revisit_closed\n0,,\n1,0,1\n-1,,\n2,0,0\n3,0,1\n";

class Offsets : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string suite =
        written(folder_ / "one.yaml", "scenarios: [" + tiny_scenario(folder_, "a") +
                                          "]\nmethods: [lvi-sam-no-loop, vs-slam]\nseeds: [1, 2]\n");
    plan_ = plan_suite(load_suite(suite), folder_ / "out");
    for (const PlannedRun& run : plan_.runs()) {
      Metrics metrics;
      metrics.loops.candidates = run.method == Method::vs_slam ? 4 : 0;
      metrics.loops.revisits = 3;
      fake_result(plan_, run, metrics);
      write_file(run.folder / "scans.csv", kScans);
      write_tum(run.folder / "truth.tum", truth());
    }
  }
  std::filesystem::path folder_ = fresh_folder("suite_offsets");
  SuitePlan plan_;
};

TEST_F(Offsets, AreAcrossTheOlderHeadingAndCountedOverAllRuns) {
  const auto offsets = recall_over_offset(SuiteFigures(plan_, {}));
  ASSERT_EQ(offsets.size(), 1u);  // the other method looks for no loops
  EXPECT_EQ(offsets[0].method, Method::vs_slam);
  std::vector<std::pair<int, int>> counts;
  for (const OffsetBin& bin : offsets[0].bins) counts.emplace_back(bin.revisits, bin.closed);
  EXPECT_THAT(counts, ::testing::ElementsAre(std::pair(2, 0), std::pair(2, 2), std::pair(0, 0),
                                             std::pair(0, 0), std::pair(2, 2)));
  EXPECT_EQ(
      offsets_csv(offsets),
      "method,offset_from_m,offset_to_m,revisits,closed,recall\nvs-slam,0,0.5,2,0,0\nvs-slam,0.5,1.5,2,2,1\n"
      "vs-slam,1.5,2.5,0,0,\nvs-slam,2.5,3.5,0,0,\nvs-slam,3.5,4,2,2,1\n");
}

TEST_F(Offsets, ABrokenResultIsAnErrorThatNamesIt) {
  const auto file = plan_.runs()[2].folder / "scans.csv";
  for (const char* broken : {"key,revisit_of,revisit_closed\n0,,\n",
                             "key,revisit_of,revisit_closed\n0,,\n1,7,1\n-1,,\n2,0,0\n3,0,1\n"}) {
    write_file(file, broken);
    try {
      recall_over_offset(SuiteFigures(plan_, {}));
      FAIL() << broken;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), ::testing::HasSubstr(file.string()));
    }
  }
}

}  // namespace
}  // namespace vsslam

#include "scenarios/suite/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "scenarios/experiment/library_files.h"
#include "scenarios/suite/suite_plan.h"
#include "tests/scenarios/suite/suite_in_scratch.h"

namespace vsslam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string error_of(const std::string& yaml) {
  const std::string file = written(fresh_folder("suite_errors") / "s.yaml", yaml);
  try {
    load_suite(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Suite, BadYamlTellsPlaceAndNearestWord) {
  EXPECT_THAT(error_of("scenarios: [quick_room]\nmethod: [all]\n"),
              HasSubstr("s.yaml:2:1: unknown key \"method\" (did you mean methods?)"));
  EXPECT_THAT(error_of("scenarios: [quick_rom]\n"), HasSubstr("s.yaml:1:12: scenarios"));
  EXPECT_THAT(error_of("scenarios: [quick_rom]\n"), HasSubstr("did you mean quick_room?"));
  EXPECT_THAT(error_of("scenarios: [quick_room]\nmethods: [vs-slm]\n"), HasSubstr("did you mean vs-slam?"));
  EXPECT_THAT(error_of("scenarios: [no/such.yaml]\n"), HasSubstr("s.yaml:1:12: scenarios: expected files"));
  EXPECT_THAT(error_of("methods: [all]\n"), HasSubstr("at least one scenario"));
  EXPECT_THAT(error_of("scenarios: [quick_room]\nexpect: {all: {ate_rms_m: {max: 1}}}\n"),
              HasSubstr("did you mean ate_rmse_m?"));
  EXPECT_THAT(error_of("scenarios: [quick_room]\nreference: {figures: {x: {vs-slam: {ate_rms_m: 1}}}}\n"),
              HasSubstr("did you mean ate_rmse_m?"));
  EXPECT_THAT(error_of("scenarios: [quick_room]\nseeds: [one]\n"), HasSubstr("s.yaml:2:9"));
}

TEST(Suite, ASettingThatNoScenarioHasIsAnError) {
  const auto folder = fresh_folder("suite_setting");
  const Suite suite = load_suite(tiny_suite(folder, "settings: {max_duraton_s: 3}\n"));
  try {
    plan_suite(suite, folder);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("suite tiny: scenario"));
    EXPECT_THAT(e.what(), HasSubstr("did you mean max_duration_s?"));
  }
}

TEST(Suite, SettingsApplyToEveryScenarioAndComeBeforeThoseOfTheCommandLine) {
  const auto folder = fresh_folder("suite_settings");
  const Suite suite = load_suite(tiny_suite(folder, "settings: {max_duration_s: 3, map_voxel_m: 0.3}\n"));
  const SuitePlan plan = plan_suite(suite, folder, {Override{"map_voxel_m", "0.4"}});
  ASSERT_EQ(plan.scenarios.size(), 2u);
  for (const Scenario& scenario : plan.scenarios) {
    EXPECT_EQ(scenario.max_duration_s, 3);
    EXPECT_EQ(scenario.map_voxel_m, 0.4);
  }
}

TEST(Suite, PlansScenariosThenMethodsThenSeeds) {
  const auto folder = fresh_folder("suite_plan");
  const SuitePlan plan = plan_suite(load_suite(tiny_suite(folder)), folder / "out");
  const std::vector<PlannedRun> runs = plan.runs();
  ASSERT_EQ(runs.size(), 8u);
  EXPECT_EQ(runs[0].folder, folder / "out" / "tiny" / "a" / "lvi-sam-no-loop" / "seed_1");
  EXPECT_EQ(runs[1].folder, folder / "out" / "tiny" / "a" / "lvi-sam-no-loop" / "seed_2");
  EXPECT_EQ(runs[7].folder, folder / "out" / "tiny" / "b" / "vs-slam" / "seed_2");
}

TEST(Suite, TwoScenariosOfOneNameCannotShareAFolder) {
  const auto folder = fresh_folder("suite_twice");
  tiny_suite(folder);
  const std::string twice = written(folder / "twice.yaml", "scenarios: [a.yaml, a.yaml]\n");
  EXPECT_THROW(plan_suite(load_suite(twice), folder), InputError);
}

TEST(Suite, TheSavedSuiteIsASuite) {
  const auto folder = fresh_folder("suite_saved");
  Suite suite =
      load_suite(tiny_suite(folder, "reference: {source: x, figures: {a: {vs-slam: {ate_rmse_m: 1}}}}\n"));
  const Suite again = load_suite(written(folder / "again.yaml", save_config(suite)));
  EXPECT_EQ(save_config(again), save_config(suite));
  EXPECT_EQ(again.reference.find("a", "vs-slam", "ate_rmse_m"), 1.0);
  EXPECT_EQ(again.reference.find("b", "vs-slam", "ate_rmse_m"), std::nullopt);
}

TEST(Suite, EverySuiteOfTheLibraryLoads) {
  EXPECT_THAT(library_names("suites"), ::testing::Contains("smoke"));
  for (const std::string& name : library_names("suites")) {
    const SuitePlan plan = plan_suite(load_suite(name), scratch_folder());
    EXPECT_FALSE(plan.runs().empty()) << name;
  }
}

// Where a result stands there is a question of its scenario and its build.
TEST(Suite, AResultCountsIfScenarioAndBuildAreTheSame) {
  const auto folder = fresh_folder("suite_stored");
  const Suite suite = load_suite(tiny_suite(folder));
  const SuitePlan plan = plan_suite(suite, folder / "out");
  const PlannedRun run = plan.runs().front();
  EXPECT_EQ(stored_run(plan, run), StoredRun::none);
  fake_result(plan, run, {});
  EXPECT_EQ(stored_run(plan, run), StoredRun::same);
  EXPECT_EQ(stored_run(plan_suite(suite, folder / "out", {Override{"max_duration_s", "2.5"}}), run),
            StoredRun::other_scenario);
  write_file(run.folder / "timing.json", "{\"made_by\": \"0123456789abcdef\"}");
  EXPECT_EQ(stored_run(plan, run), StoredRun::other_build);
  std::filesystem::remove(run.folder / "timing.json");
  EXPECT_EQ(stored_run(plan, run), StoredRun::other_build);
  std::filesystem::remove(run.folder / "metrics.json");
  EXPECT_EQ(stored_run(plan, run), StoredRun::none);
}

}  // namespace
}  // namespace vsslam

#include "scenarios/experiment/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/experiment/library_files.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string error_of(const std::string& yaml) {
  Scenario scenario;
  try {
    load_config_text(yaml, "x.yaml", scenario, library());
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

class LibraryScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(LibraryScenario, SavesToTheSameTextAfterReloading) {
  const Scenario scenario = load_scenario(GetParam());
  const std::string saved = save_config(scenario);
  Scenario again;
  load_config_text(saved, "saved.yaml", again, library());
  EXPECT_EQ(save_config(again), saved);
  EXPECT_EQ(again.name, GetParam());
  EXPECT_FALSE(scenario.description.empty());
}

INSTANTIATE_TEST_SUITE_P(All, LibraryScenario, ::testing::ValuesIn(library_names("scenarios")),
                         [](const auto& info) { return info.param; });

TEST(Scenario, TakesItsNameFromTheFileAndItsRestFromTheBase) {
  const std::filesystem::path path = scratch_folder() / "my_scenario.yaml";
  write_file(path, "base: quick_room\nseeds: [3, 4]\nlighting: {preset: low}\n");
  const Scenario base = load_scenario("quick_room");
  const Scenario scenario = load_scenario(path.string(), {{"max_duration_s", "9"}});
  EXPECT_EQ(scenario.name, "my_scenario");
  EXPECT_THAT(scenario.seeds, ElementsAre(3, 4));
  EXPECT_EQ(scenario.lighting.preset, LightingConfig::Preset::low);
  EXPECT_EQ(scenario.max_duration_s, 9);
  EXPECT_EQ(scenario.drive.steps.size(), base.drive.steps.size());
  EXPECT_EQ(save_config(scenario.world), save_config(base.world));
}

TEST(Scenario, MistakesHaveAPlaceAndAHint) {
  EXPECT_EQ(error_of("max_duraton_s: 3\n"),
            "x.yaml:1:1: unknown key \"max_duraton_s\" (did you mean max_duration_s?)");
  EXPECT_THAT(error_of("lighting: {preset: drak}\n"),
              HasSubstr("x.yaml:1:20: preset: unknown value \"drak\" (did you mean dark?)"));
  EXPECT_THAT(error_of("closed_loop_latency_s: -1\n"), HasSubstr("x.yaml:1:24"));
  EXPECT_THAT(error_of("seeds: []\n"), HasSubstr("at least one seed"));
  EXPECT_THAT(error_of("name: a/b\n"), HasSubstr("x.yaml:1:7"));
  EXPECT_THAT(error_of("events:\n  wheel_slip:\n    - {at_s: 3, left_frition: 1}\n"),
              HasSubstr("x.yaml:3:17: unknown key \"left_frition\" (did you mean left_friction?)"));
}

TEST(Scenario, LibraryNamesAreSuggested) {
  EXPECT_THAT(error_of("rig: {base: scout_vlp61}\n"), HasSubstr("did you mean scout_vlp16?"));
  EXPECT_THAT(error_of("base: corridor_1\n"), HasSubstr("x.yaml:1:7"));
  try {
    load_scenario("corridr_01");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "no scenario \"corridr_01\" (did you mean corridor_01?)");
  }
  EXPECT_THROW(load_scenario("nowhere/corridor_01.yaml"), InputError);
}

TEST(Scenario, MethodsAreCheckedAndListedOnce) {
  EXPECT_EQ(resolve_methods({"all"}), all_methods());
  EXPECT_THAT(resolve_methods({"lvi-sam", "sc-lvi-sam", "lvi-sam"}),
              ElementsAre(Method::lvi_sam, Method::sc_lvi_sam));
  try {
    resolve_methods({"sc-lvi-smm"});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("sc-lvi-sam"));
  }
}

// The yaml block of docs/scenarios.md without its comments.
std::string documented_defaults() {
  std::istringstream doc(read_file(std::filesystem::path(VSSLAM_SOURCE_DIR) / "docs/scenarios.md"));
  std::string text;
  bool inside = false;
  for (std::string line; std::getline(doc, line);) {
    if (line.starts_with("```"))
      inside = line == "```yaml";
    else if (inside)
      text += line.substr(0, line.find("  # ")) + "\n";
  }
  return text;
}

TEST(Scenario, EveryKeyAndDefaultIsDocumented) {
  EXPECT_EQ(documented_defaults(), save_config(Scenario{}));
}

TEST(Expectations, NamesAreChecked) {
  EXPECT_EQ(error_of("expect: {all: {ate_rmse_m: {max: 0.1}}, lvi-sam: {loops.false: {max: 0}}}\n"), "");
  EXPECT_THAT(error_of("expect: {al: {ate_rmse_m: {max: 0.1}}}\n"), HasSubstr("did you mean all?"));
  EXPECT_THAT(error_of("expect: {all: {ate_rsme_m: {max: 0.1}}}\n"), HasSubstr("did you mean ate_rmse_m?"));
  EXPECT_THAT(error_of("expect: {all: {ate_rmse_m: {}}}\n"), HasSubstr("min, max or both"));
  EXPECT_THAT(error_of("expect: {all: {ate_rmse_m: {max: 1, most: 1}}}\n"), HasSubstr("unknown key \"most\""));
}

TEST(Expectations, AMethodsOwnBoundReplacesThatOfAll) {
  Scenario scenario;
  load_config_text(
      "expect:\n  all: {ate_rmse_m: {max: 1}, ate_max_m: {max: 2}}\n  lvi-sam: {ate_rmse_m: {min: 3}}\n",
      "x.yaml", scenario);
  const MetricBounds bounds = bounds_for(scenario.expect, "lvi-sam");
  EXPECT_EQ(bounds.size(), 2u);
  EXPECT_EQ(bounds.at("ate_rmse_m").text(), ">= 3");
  EXPECT_EQ(bounds.at("ate_max_m").text(), "<= 2");
  EXPECT_EQ(bounds_for(scenario.expect, "sc-lvi-sam").at("ate_rmse_m").text(), "<= 1");
}

}  // namespace
}  // namespace vsslam

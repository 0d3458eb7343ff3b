#include "scenarios/cli/cli.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/run/progress.h"
#include "slam/loop/loop_config.h"
#include "tests/scenarios/command_line.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string temporary(const std::string& name, const std::string& text) {
  const std::filesystem::path path = scratch_folder() / name;
  write_file(path, text);
  return path.string();
}

TEST(Cli, SeedsAreRangesAndLists) {
  EXPECT_THAT(parse_seeds("1-5"), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(parse_seeds("3"), ElementsAre(3));
  EXPECT_THAT(parse_seeds("9,1-2,9"), ElementsAre(9, 1, 2));
  for (const char* bad : {"", "a", "1-", "-3", "5-1", "1,,2", "1-99999999999", "1.5"})
    EXPECT_THROW(parse_seeds(bad), InputError) << bad;
}

TEST(Cli, MistypedWordsGetAHint) {
  const Outcome command = call({"rnu", "quick_room"});
  EXPECT_EQ(command.code, kBadInput);
  EXPECT_THAT(command.err, HasSubstr("unknown command \"rnu\" (did you mean run?)"));
  const Outcome option = call({"run", "quick_room", "--sedes", "1"});
  EXPECT_EQ(option.code, kBadInput);
  EXPECT_THAT(option.err, HasSubstr("run: unknown option --sedes (did you mean --seeds?)"));
  const Outcome scenario = call({"run", "quick_rom"});
  EXPECT_EQ(scenario.code, kBadInput);
  EXPECT_THAT(scenario.err, HasSubstr("did you mean quick_room?"));
  const Outcome suite = call({"suite", "smoek"});
  EXPECT_EQ(suite.code, kBadInput);
  EXPECT_THAT(suite.err, HasSubstr("did you mean smoke?"));
  const Outcome method = call({"run", "quick_room", "--method", "sc-lvi-smm"});
  EXPECT_EQ(method.code, kBadInput);
  EXPECT_THAT(method.err, HasSubstr("sc-lvi-sam"));
  const Outcome setting = call({"run", "quick_room", "--set", "max_duraton_s=3"});
  EXPECT_EQ(setting.code, kBadInput);
  EXPECT_THAT(setting.err, HasSubstr("did you mean max_duration_s?"));
}

TEST(Cli, BadInputIsCode2WithOneLine) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"run"},
                                                    {"run", "no/such.yaml"},
                                                    {"run", "quick_room", "--threads", "0"},
                                                    {"run", "quick_room", "--seeds", "x"},
                                                    {"run", "quick_room", "--set", "nonsense"},
                                                    {"evaluate", "/nowhere/a.tum", "/nowhere/b.tum"},
                                                    {"optimize", "/nowhere.g2o"},
                                                    {"report", "/nowhere"},
                                                    {"suite"},
                                                    {"suite", "smoek"},
                                                    {"suite", "smoke", "--fresh", "--resume"},
                                                    {"suite", "smoke", "--scenarios", "quick_rom"},
                                                    {"suite", "smoke", "--set", "nonsense=1"},
                                                    {"world", "corridr"},
                                                    {"world", "room", "--out", "x.obj"},
                                                    {"list", "more"}}) {
    const Outcome outcome = call(arguments);
    EXPECT_EQ(outcome.code, kBadInput) << ::testing::PrintToString(arguments);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(Cli, HelpIsNotAnError) {
  for (const char* command : {"run", "suite", "world", "evaluate", "optimize", "report", "list"}) {
    const Outcome outcome = call({command, "--help"});
    EXPECT_EQ(outcome.code, kDone);
    EXPECT_THAT(outcome.out, HasSubstr("--threads"));
  }
}

TEST(Cli, ListKnowsTheLibrary) {
  const auto json = nlohmann::json::parse(call({"list", "--json"}).out);
  EXPECT_EQ(json["methods"].size(), all_methods().size());
  EXPECT_THAT(json["worlds"].get<std::vector<std::string>>(), ::testing::Contains("corridor_ring"));
  EXPECT_THAT(call({"list"}).out, HasSubstr("quick_room"));
}

TEST(Cli, EvaluatePrintsTheContract) {
  std::string truth, estimate;
  for (int i = 0; i <= 30; ++i) {
    truth += std::to_string(i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
    estimate +=
        std::to_string(i) + " " + std::to_string(i) + (i % 2 == 0 ? " 0.5" : " -0.5") + " 0 0 0 0 1\n";
  }
  const Outcome outcome = call(
      {"evaluate", temporary("e.tum", estimate), temporary("t.tum", truth), "--align", "none", "--json"});
  ASSERT_EQ(outcome.code, kDone) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_NEAR(json["ate_rmse_m"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(json["ate_max_m"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(json["ate_mean_m"].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(json["pairs"], 31);
  EXPECT_EQ(json["coverage"], 1.0);
  EXPECT_EQ(json.size(), 7u);
}

TEST(Cli, OptimizePrintsTheContract) {
  const std::string file =
      temporary("g.g2o",
                "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 2 0 0 0 0 0 1\nFIX 0\n"
                "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 1 0 0 1 0 1\n");
  const Outcome outcome = call({"optimize", file, "--json"});
  ASSERT_EQ(outcome.code, kDone) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["poses"], 2);
  EXPECT_EQ(json["edges"], 1);
  EXPECT_NEAR(json["initial_cost"].get<double>(), 4.0, 1e-9);
  EXPECT_NEAR(json["final_cost"].get<double>(), 0.0, 1e-9);
}

TEST(Cli, WorldIsWrittenAndDescribed) {
  const std::string glb = (scratch_folder() / "room.glb").string();
  const Outcome made =
      call({"world", "room", "--set", "length_m=11", "--set", "textures=false", "--out", glb});
  ASSERT_EQ(made.code, kDone) << made.err;
  const Outcome described = call({"world", glb, "--info", "--json"});
  ASSERT_EQ(described.code, kDone) << described.err;
  const auto json = nlohmann::json::parse(described.out);
  EXPECT_GT(json["triangles"].get<int>(), 100);
  const double length_m =
      json["extent"]["high_m"][0].get<double>() - json["extent"]["low_m"][0].get<double>();
  EXPECT_NEAR(length_m, 11.0, 0.6);
}

class FakeClock final : public StageClock {
 public:
  int64_t now_ns() override { return ns; }
  void record(const char*, int64_t) override {}
  int64_t ns = 0;
};

TEST(Progress, DescribesRateAndTimeLeft) {
  EXPECT_EQ(Progress::describe({.done_s = 30, .expected_s = 120, .scans = 300}, 2.0),
            " 25 %  30 of 120 s  150 scans/s  15.0 x real time  6 s left");
  EXPECT_THAT(Progress::describe({.done_s = 1, .expected_s = 121, .runs = 3}, 1.0),
              HasSubstr("2 min 00 s left  (0 of 3 runs)"));
}

TEST(Progress, PrintsALinePerTenth) {
  FakeClock clock;
  std::ostringstream out;
  {
    Progress progress(Progress::Style::lines, out, clock, "x");
    for (int i = 0; i <= 100; ++i) {
      clock.ns += 10'000'000;
      progress.update({.done_s = static_cast<double>(i), .expected_s = 100});
    }
  }
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
}

TEST(Progress, QuietSaysNothing) {
  FakeClock clock;
  std::ostringstream out;
  Progress progress(Progress::Style::none, out, clock, "x");
  progress.update({.done_s = 1, .expected_s = 1});
  progress.note("y");
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace vsslam

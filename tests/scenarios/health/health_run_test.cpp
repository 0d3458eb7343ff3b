// Health at the end of whole runs: on the screen, in metrics.json, on the page and in the exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "tests/scenarios/command_line.h"
#include "tests/scenarios/suite/suite_in_scratch.h"

namespace vsslam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Ran {
  Outcome outcome;
  nlohmann::json metrics;
  std::string page;
};

Ran run_with(const std::string& name, const std::string& more) {
  const std::filesystem::path folder = fresh_folder("health_" + name);
  const std::filesystem::path file = tiny_scenario(folder, name);
  write_file(file, read_file(file) + more);
  const Outcome outcome = call({"run", file.string(), "--out", (folder / "runs").string(), "--quiet"});
  const std::filesystem::path result = folder / "runs" / name / "vs-slam" / "seed_1";
  return {outcome, nlohmann::json::parse(read_file(result / "metrics.json")),
          read_file(result / "report.html")};
}

TEST(HealthOfARun, IsGoodInARoom) {
  const auto [outcome, metrics, page] = run_with("well", "");
  EXPECT_EQ(outcome.code, kDone) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("health"), HasSubstr("ok"), Not(HasSubstr("warning"))));
  const nlohmann::json& health = metrics["health"];
  EXPECT_TRUE(health["warnings"].empty()) << health.dump(2);
  EXPECT_TRUE(health["worthless"].is_null());
  EXPECT_EQ(health["scans_prior_only"], 0);
  EXPECT_EQ(health["sensors"]["lidar"]["used"], metrics["scans"]);
  EXPECT_NEAR(health["sensors"]["lidar"]["rate_hz"].get<double>(), 10, 0.1);
  EXPECT_NEAR(health["sensors"]["imu"]["gravity_mps2"].get<double>(), 9.8, 0.3);
  EXPECT_EQ(metrics["coverage"], 1.0);
  EXPECT_THAT(page, AllOf(HasSubstr("<section id=\"health\">"), HasSubstr("sensors healthy")));
}

TEST(HealthOfARun, WithABlindLidarIsWorthlessAndSaysSo) {
  const auto [outcome, metrics, page] = run_with(
      "blind",
      "events: {lidar_blocked_sectors: [{from_s: 0.5, from_deg: 0, to_deg: 180},"
      " {from_s: 0.5, from_deg: 180, to_deg: 360}]}\nexpect: {all: {health.scans_prior_only: {min: 1}, "
      "ate_rmse_m: {max: 100}}}\n");
  EXPECT_EQ(outcome.code, kExpectationFailed) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("WORTHLESS: "), HasSubstr("PASS  health.scans_prior_only"),
                                 HasSubstr(" !"), Not(HasSubstr("FAIL"))));
  EXPECT_THAT(metrics["health"]["worthless"].get<std::string>(), HasSubstr("the LiDAR gave nothing in"));
  EXPECT_THAT(page, HasSubstr("<span class=\"chip bad\">worthless</span>"));
}

TEST(HealthOfARun, WithASilentLidarIsWorthlessToo) {
  const auto [outcome, metrics, page] =
      run_with("silent", "events: {lidar_dropouts: [{from_s: 0.5, to_s: 1.9}]}\n");
  EXPECT_EQ(outcome.code, kExpectationFailed) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("warning: lidar: no scans for 1.3 s"), HasSubstr("WORTHLESS: ")));
  EXPECT_THAT(metrics["health"]["worthless"].get<std::string>(), HasSubstr("silent for"));
}

// One pose in common: any alignment makes its error zero.
TEST(Evaluate, NeedsThreePosesThatAreNotOnALine) {
  const std::filesystem::path folder = fresh_folder("evaluate_few");
  std::string estimate, line;
  for (int i = 0; i < 40; ++i) {
    estimate += fmt::format("{} {} {} 0 0 0 0 1\n", i, i, i * i % 7);
    line += fmt::format("{} {} 0 0 0 0 0 1\n", i, i);
  }
  const std::string whole = written(folder / "whole.tum", estimate);
  const auto with_truth = [&](const std::string& name, const std::string& truth, const char* align) {
    return call({"evaluate", whole, written(folder / name, truth), "--align", align, "--json"});
  };
  const Outcome one = with_truth("one.tum", "7 1 2 3 0 0 0 1\n", "se3");
  EXPECT_EQ(one.code, kBadInput);
  EXPECT_EQ(one.out, "");
  EXPECT_THAT(one.err, HasSubstr("1 of 40 poses have truth at the same time, and an alignment needs 3"));
  EXPECT_EQ(with_truth("two.tum", "7 1 2 3 0 0 0 1\n8 1 3 3 0 0 0 1\n", "sim3").code, kBadInput);
  const Outcome straight = with_truth("line.tum", line, "se3");
  EXPECT_EQ(straight.code, kBadInput);
  EXPECT_THAT(straight.err, HasSubstr("positions of the truth lie on one line"));
  EXPECT_EQ(with_truth("line.tum", line, "none").code, kDone);
  const Outcome few = with_truth("few.tum", estimate.substr(0, estimate.find("10 ")), "se3");
  EXPECT_EQ(few.code, kDone);
  EXPECT_THAT(few.err, HasSubstr("warning: only 25.0 % of the estimate has truth"));
  EXPECT_EQ(nlohmann::json::parse(few.out)["coverage"], 0.25);
}

}  // namespace
}  // namespace vsslam

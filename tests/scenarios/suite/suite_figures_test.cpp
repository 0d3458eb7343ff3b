#include "scenarios/suite/suite_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/suite/suite_files.h"
#include "scenarios/suite/suite_tables.h"
#include "tests/scenarios/suite/suite_in_scratch.h"

namespace vsslam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Spread, IsMeanAndSampleStandardDeviation) {
  const double values[] = {2, 4, 4, 4, 5, 5, 7, 9};
  const auto spread = spread_of(values);
  ASSERT_TRUE(spread);
  EXPECT_EQ(spread->mean, 5);
  EXPECT_DOUBLE_EQ(spread->deviation, std::sqrt(32.0 / 7));
  EXPECT_EQ(spread->low, 2);
  EXPECT_EQ(spread->high, 9);
  EXPECT_EQ(spread->count, 8u);
  EXPECT_EQ(spread_of(std::span(values, 1))->deviation, 0);
  EXPECT_EQ(spread_of({}), std::nullopt);
}

// Two scenarios, two methods, two seeds. Errors 1, 2, 3, ... cm in order of the plan; vs-slam stores and closes.
class SuiteFiguresTest : public ::testing::Test {
 protected:
  SuitePlan plan_with(const std::string& more) {
    return plan_suite(load_suite(tiny_suite(folder_, more)), folder_ / "out");
  }
  static Metrics metrics(const SuitePlan& plan, const PlannedRun& run, double ate_rmse_m) {
    Metrics m;
    m.scenario = plan.scenarios[run.scenario].name;
    m.method = method_name(run.method);
    m.seed = run.seed;
    m.ate_rmse_m = ate_rmse_m;
    m.end_error_m = 10 * ate_rmse_m;
    if (run.method != Method::vs_slam) return m;
    m.descriptors = {17, 152, 17 * 5512, 3'000'000};
    m.loops.candidates = 3;
    m.loops.true_loops = static_cast<int64_t>(run.seed);
    m.loops.recall = 0.5;
    return m;
  }
  void write_all(const SuitePlan& plan) {
    double ate_rmse_m = 0;
    for (const PlannedRun& run : plan.runs()) fake_result(plan, run, metrics(plan, run, ate_rmse_m += 0.01));
  }

  std::filesystem::path folder_ = fresh_folder("suite_figures");
};

TEST_F(SuiteFiguresTest, MeansAreOverSeedsAndOverRuns) {
  const SuitePlan plan = plan_with("");
  write_all(plan);
  const SuiteFigures figures(plan, {});
  EXPECT_EQ(figures.present(), 8u);
  EXPECT_EQ(figures.builds(), 1u);
  EXPECT_TRUE(figures.as_expected());
  const auto error = figures.over_seeds(1, Method::vs_slam, "ate_rmse_m");  // 7 and 8 cm
  EXPECT_NEAR(error->mean, 0.075, 1e-12);
  EXPECT_NEAR(error->deviation, 0.01 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(figures.over_runs(Method::vs_slam, "ate_rmse_m")->mean, (3 + 4 + 7 + 8) / 400.0, 1e-12);
  EXPECT_EQ(figures.over_runs(Method::lvi_sam_no_loop, "loops.recall"), std::nullopt);
  EXPECT_EQ(figures.over_seeds(0, Method::sc_lvi_sam, "ate_rmse_m"), std::nullopt);
}

TEST_F(SuiteFiguresTest, AResultOfABlindLidarIsMarkedAndNotAsExpected) {
  const SuitePlan plan = plan_with("");
  write_all(plan);
  const PlannedRun run = plan.runs().front();
  Metrics bad = metrics(plan, run, 0.001);
  bad.scans = 100;
  bad.health.odometry.scans = 100;
  bad.health.odometry.scans_prior_only = 60;
  bad.health.warnings = {"a", "b"};
  bad.health.worthless = "the LiDAR gave nothing";
  fake_result(plan, run, bad);
  const SuiteFigures figures(plan, {});
  EXPECT_FALSE(figures.as_expected());
  EXPECT_TRUE(figures.blind(run.scenario, run.method));
  EXPECT_EQ(figures.runs().front().value("health.warnings"), 2.0);
  const SuiteTable errors = suite_tables(figures).front();
  EXPECT_THAT(errors.rows[0].cells[0].value, HasSubstr(" !"));
  EXPECT_FALSE(errors.rows[0].cells[0].best);
  EXPECT_THAT(errors.rows[1].cells[0].value, Not(HasSubstr("!")));
  EXPECT_THAT(tables_markdown(figures), HasSubstr("worthless: the LiDAR gave nothing"));
}

TEST_F(SuiteFiguresTest, ExpectationsAreOfTheMean) {
  const SuitePlan plan = plan_with(
      "expect: {vs-slam: {ate_rmse_m: {max: 0.0551}, loops.recall: {min: 0.6}}, "
      "all: {loops.precision: {min: 0}}}\n");
  write_all(plan);
  const SuiteFigures figures(plan, {});
  const auto expected = figures.expected();
  ASSERT_EQ(expected.size(), 4u);
  EXPECT_EQ(expected[0].method, Method::lvi_sam_no_loop);
  EXPECT_FALSE(expected[0].result.pass);  // no run has a precision
  EXPECT_EQ(expected[1].result.metric, "ate_rmse_m");
  EXPECT_TRUE(expected[1].result.pass);
  EXPECT_FALSE(expected[2].result.pass);  // precision again
  EXPECT_FALSE(expected[3].result.pass);  // recall
  EXPECT_FALSE(figures.as_expected());
}

TEST_F(SuiteFiguresTest, OtherSettingsAndOtherBuildsAreNotMixedIn) {
  const SuitePlan plan = plan_with("");
  write_all(plan);
  write_file(plan.runs()[2].folder / "scenario.yaml", "name: other\n");
  write_file(plan.runs()[3].folder / "timing.json", "{\"made_by\": \"0\"}");
  std::filesystem::remove_all(plan.runs()[7].folder);
  const SuiteFigures figures(plan, {});
  EXPECT_EQ(figures.present(), 5u);
  EXPECT_FALSE(figures.as_expected());
  EXPECT_EQ(figures.runs()[2].failure, "made from other settings");
  EXPECT_EQ(figures.runs()[3].failure, "made by another build");
  EXPECT_EQ(figures.runs()[7].failure, "not made yet");
  EXPECT_EQ(figures.over_seeds(0, Method::vs_slam, "ate_rmse_m"), std::nullopt);
  EXPECT_THAT(tables_markdown(figures), HasSubstr("* a vs-slam seed 1: made from other settings"));
  const SuiteFigures any(plan, {}, true);
  EXPECT_EQ(any.present(), 6u);
  EXPECT_EQ(any.builds(), 2u);
}

TEST_F(SuiteFiguresTest, AFailedRunIsReported) {
  const SuitePlan plan = plan_with("");
  write_all(plan);
  Metrics stuck = metrics(plan, plan.runs()[0], 0.01);
  stuck.failure = "stuck at 3 s";
  fake_result(plan, plan.runs()[0], stuck);
  const std::vector<SuiteFailure> failures = {{1, Method::vs_slam, 2, "no luck"}};
  const SuiteFigures figures(plan, failures);
  EXPECT_FALSE(figures.as_expected());
  EXPECT_TRUE(figures.runs()[0].present);
  EXPECT_EQ(figures.runs()[0].failure, "stuck at 3 s");
  EXPECT_FALSE(figures.runs()[7].present);
  EXPECT_EQ(figures.runs()[7].failure, "no luck");
  const CsvTable summary = CsvTable::parse(summary_csv(figures), "summary.csv");
  EXPECT_EQ(summary.rows(), 8u);
  EXPECT_EQ(summary.text(0, "failure"), "stuck at 3 s");
  EXPECT_EQ(summary.text(7, "failure"), "no luck");
  EXPECT_EQ(summary.number(1, "ate_rmse_m"), 0.02);
  EXPECT_EQ(summary.text(7, "ate_rmse_m"), "");
}

TEST_F(SuiteFiguresTest, TablesHaveThePapersFormWithItsFiguresBeside) {
  const SuitePlan plan = plan_with(
      "error_metric: {b: end_error_m}\n"
      "reference: {source: A paper, figures: {a: {vs-slam: {descriptors.count: 18, descriptors.index_bytes: "
      "151, "
      "ate_rmse_m: 0.67}}}}\n");
  write_all(plan);
  const std::string text = tables_markdown(SuiteFigures(plan, {}));
  EXPECT_THAT(text, HasSubstr("In brackets: A paper."));
  EXPECT_THAT(text, HasSubstr("| sequence | lvi-sam-no-loop | vs-slam |\n|---|---:|---:|\n"
                              "| a | **0.015** ± 0.007 | 0.035 ± 0.007 [0.67] |\n"
                              "| b | **0.550** ± 0.071 | 0.750 ± 0.071 |\n"));
  EXPECT_THAT(
      text, HasSubstr("| sequence | vs-slam |\n|---|---:|\n| a | 17 / 152 [18 / 151] |\n| b | 17 / 152 |\n"));
  EXPECT_THAT(text, HasSubstr("| a | 93.7 kB / 3.0 MB |"));
  EXPECT_THAT(text, HasSubstr("| a | 1.5 / 0 |"));
  const CsvTable table = CsvTable::parse(tables_csv(SuiteFigures(plan, {})), "tables.csv");
  size_t row = 0;
  while (table.text(row, "scenario") != "a" || table.text(row, "method") != "vs-slam" ||
         table.text(row, "metric") != "ate_rmse_m")
    ++row;
  EXPECT_NEAR(table.number(row, "mean"), 0.035, 1e-12);
  EXPECT_EQ(table.integer(row, "seeds"), 2);
  EXPECT_EQ(table.number(row, "reference"), 0.67);
}

TEST_F(SuiteFiguresTest, SaysWhereTheFocusIsBehind) {
  const SuitePlan plan = plan_with("");
  write_all(plan);
  EXPECT_THAT(losses(SuiteFigures(plan, {})),
              ElementsAre("a: the error of vs-slam (0.035 m) is behind lvi-sam-no-loop (0.015 m).",
                          "b: the error of vs-slam (0.075 m) is behind lvi-sam-no-loop (0.055 m)."));
  const SuitePlan other = plan_with("focus: lvi-sam-no-loop\n");
  EXPECT_THAT(losses(SuiteFigures(other, {})), IsEmpty());
  EXPECT_THAT(tables_markdown(SuiteFigures(other, {})), HasSubstr("Nowhere, to the digits shown."));
}

TEST_F(SuiteFiguresTest, ALossWithinTheSpreadIsCalledSo) {
  const SuitePlan plan = plan_with("");
  for (const PlannedRun& run : plan.runs()) {
    const double base = run.method == Method::vs_slam ? 0.031 : 0.029;
    fake_result(plan, run, metrics(plan, run, base + 0.01 * static_cast<double>(run.seed)));
  }
  EXPECT_THAT(losses(SuiteFigures(plan, {}))[0], HasSubstr("(0.044 m, within the spread over seeds)"));
}

TEST_F(SuiteFiguresTest, TimingHasAFileOfItsOwn) {
  const SuitePlan plan = plan_with("");
  write_all(plan);
  const SuiteFigures figures(plan, {});
  const CsvTable timing = CsvTable::parse(timing_csv(figures), "timing.csv");
  EXPECT_EQ(timing.rows(), 8u);
  EXPECT_EQ(timing.number(3, "slam_scan_p99_ms"), 9);
  EXPECT_EQ(timing.number(3, "real_time_factor"), 5);
  EXPECT_THAT(summary_csv(figures) + tables_csv(figures) + tables_markdown(figures),
              Not(HasSubstr("real_time")));
}

TEST(SuiteNumbers, HaveThreeDigitsOrSo) {
  EXPECT_EQ(metres_text(0.0314), "0.031");
  EXPECT_EQ(metres_text(15.589), "15.59");
  EXPECT_EQ(metres_text(123.45), "123.5");
  EXPECT_EQ(bytes_text(1048), "1048 B");
  EXPECT_EQ(bytes_text(5512), "5.5 kB");
  EXPECT_EQ(bytes_text(3.04e6), "3.0 MB");
}

}  // namespace
}  // namespace vsslam

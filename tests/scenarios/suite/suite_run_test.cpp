// Suites of a tiny scenario, really run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/errors.h"
#include "core/ordered_parallel.h"
#include "scenarios/stages/wall_clock.h"
#include "scenarios/suite/suite_runner.h"
#include "tests/scenarios/command_line.h"
#include "tests/scenarios/suite/suite_in_scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string without_timing_panel(std::string html) {
  const size_t from = html.find("<!-- timing begin -->"), to = html.find("<!-- timing end -->");
  return from == html.npos ? html : html.erase(from, to - from);
}

/// Path inside the folder -> content, without what tells the time.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name == "timing.json" || name == "timing.csv") continue;
    files[fs::relative(entry.path(), folder).string()] =
        name == "report.html" ? without_timing_panel(read_file(entry.path())) : read_file(entry.path());
  }
  return files;
}

void expect_same(const fs::path& a, const fs::path& b) {
  const auto files_a = contents(a), files_b = contents(b);
  ASSERT_GT(files_a.size(), 12u);
  ASSERT_EQ(files_a.size(), files_b.size());
  for (const auto& [name, bytes] : files_a) {
    ASSERT_TRUE(files_b.contains(name)) << name;
    EXPECT_TRUE(files_b.at(name) == bytes) << name << " differs";
  }
}

std::map<std::string, fs::file_time_type> times(const SuitePlan& plan) {
  std::map<std::string, fs::file_time_type> all;
  for (const PlannedRun& run : plan.runs())
    if (fs::exists(run.folder)) all[run.folder.string()] = fs::last_write_time(run.folder / "metrics.json");
  return all;
}

SuiteRunner run_suite(const SuitePlan& plan, int threads, bool fresh = false) {
  set_thread_count(threads);
  SuiteRunner runner(plan, {.threads = threads, .fresh = fresh});
  std::ostringstream quiet;
  WallClock clock;
  Progress progress(Progress::Style::none, quiet, clock, "");
  runner.run(std::atomic<bool>(false), progress);
  return runner;
}

TEST(SuiteRun, ResumesExactlyWhatIsMissingOrDifferent) {
  const fs::path folder = fresh_folder("suite_resume");
  const SuitePlan plan = plan_suite(load_suite(tiny_suite(folder)), folder / "out");
  EXPECT_EQ(run_suite(plan, 2).made(), 8);
  const auto first = times(plan);
  ASSERT_EQ(first.size(), 8u);

  const SuiteRunner nothing = run_suite(plan, 2);
  EXPECT_EQ(nothing.kept(), 8);
  EXPECT_EQ(nothing.made(), 0);
  EXPECT_EQ(times(plan), first);

  fs::remove_all(plan.runs()[1].folder);                                        // missing
  write_file(plan.runs()[4].folder / "scenario.yaml", "name: another\n");       // other settings
  write_file(plan.runs()[7].folder / "timing.json", "{\"made_by\": \"0\"}\n");  // another build
  const SuiteRunner some = run_suite(plan, 2);
  EXPECT_EQ(some.kept(), 5);
  EXPECT_EQ(some.made(), 3);
  const auto second = times(plan);
  for (size_t i = 0; i < 8; ++i) {
    const std::string run = plan.runs()[i].folder.string();
    EXPECT_EQ(second.at(run) != first.at(run), i == 1 || i == 4 || i == 7) << run;
    EXPECT_EQ(stored_run(plan, plan.runs()[i]), StoredRun::same);
  }
}

TEST(SuiteRun, AChangedSettingIsNotMixedIn) {
  const fs::path folder = fresh_folder("suite_changed");
  const std::string suite = tiny_suite(folder);
  const std::vector<std::string> common = {"suite",       suite,
                                           "--scenarios", (folder / "a.yaml").string(),
                                           "--seeds",     "1",
                                           "--method",    "lvi-sam-no-loop",
                                           "--out",       (folder / "out").string()};
  auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    return call(more);
  };
  ASSERT_EQ(with({"--quiet"}).code, kDone);
  const Outcome changed = with({"--set", "max_duration_s=1.5", "--json"});
  ASSERT_EQ(changed.code, kDone) << changed.err;
  EXPECT_THAT(changed.err, HasSubstr("1 runs to make, 0 kept"));
  const auto json = nlohmann::json::parse(changed.out);
  EXPECT_EQ(json["present"], 1);
  EXPECT_EQ(json["as_expected"], true);
  const auto metrics = nlohmann::json::parse(
      read_file(folder / "out" / "tiny" / "a" / "lvi-sam-no-loop" / "seed_1" / "metrics.json"));
  EXPECT_NEAR(metrics["duration_s"].get<double>(), 1.5, 1e-9);
}

TEST(SuiteRun, SameBytesForOneAndTwoThreadsAndAfterAnInterruption) {
  const fs::path folder = fresh_folder("suite_bytes");
  const std::string suite = tiny_suite(folder);
  for (const char* threads : {"1", "2"})
    ASSERT_EQ(
        call({"suite", suite, "--quiet", "--threads", threads, "--out", (folder / threads).string()}).code,
        kDone);
  expect_same(folder / "1", folder / "2");

  // Stopped after the first result of the other scenario, then gone on with.
  const SuitePlan plan = plan_suite(load_suite(suite), folder / "stopped");
  std::atomic<bool> stop = false;
  SuiteRunner runner(plan, {.threads = 2});
  class Watcher final : public StageClock {
   public:
    Watcher(const fs::path& place, std::atomic<bool>& stop) : place_(place), stop_(stop) {}
    int64_t now_ns() override {
      if (fs::exists(place_)) stop_ = true;
      return 0;
    }
    void record(const char*, int64_t) override {}

   private:
    fs::path place_;
    std::atomic<bool>& stop_;
  } watcher(plan.folder / "a", stop);
  std::ostringstream quiet;
  {
    Progress progress(Progress::Style::lines, quiet, watcher, "");
    EXPECT_THROW(runner.run(stop, progress), Interrupted);
  }
  EXPECT_LT(runner.made(), 8);
  for (const auto& entry : fs::recursive_directory_iterator(plan.folder)) {  // whole results, nothing else
    const bool result = entry.path().filename().string().starts_with("seed_");
    EXPECT_TRUE(!result || fs::exists(entry.path() / "report.html")) << entry.path();
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
  ASSERT_EQ(call({"suite", suite, "--quiet", "--threads", "2", "--out", (folder / "stopped").string()}).code,
            kDone);
  expect_same(folder / "1", folder / "stopped");
}

TEST(SuiteRun, AFailingRunDoesNotStopTheOthers) {
  const fs::path folder = fresh_folder("suite_failing");
  tiny_suite(folder);
  written(folder / "bad.yaml",
          "base: quick_room\nmax_duration_s: 2\nworld: {room: {textures: false}}\n"
          "drive: {steps: [{follow: {route: no_such_route}}]}\n");
  const std::string suite = written(folder / "failing.yaml",
                                    "scenarios: [bad.yaml, a.yaml]\nmethods: [lvi-sam-no-loop, vs-slam]\n");
  const Outcome outcome = call({"suite", suite, "--out", (folder / "out").string()});
  EXPECT_EQ(outcome.code, kExpectationFailed) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("bad vs-slam seed 1 failed: "));
  EXPECT_THAT(outcome.out, HasSubstr("no_such_route"));
  EXPECT_THAT(read_file(folder / "out" / "failing" / "summary.csv"), HasSubstr("no_such_route"));
  EXPECT_TRUE(fs::exists(folder / "out" / "failing" / "a" / "vs-slam" / "seed_1" / "metrics.json"));
}

TEST(SuiteRun, ReportRebuildsTheTables) {
  const fs::path folder = fresh_folder("suite_report");
  const std::string suite = tiny_suite(folder);
  const fs::path place = folder / "out" / "tiny";
  ASSERT_EQ(call({"suite", suite, "--quiet", "--seeds", "1", "--out", (folder / "out").string()}).code,
            kDone);
  const auto before = contents(place);
  for (const char* name : {"summary.csv", "tables.csv", "tables.md", "report.html"}) fs::remove(place / name);
  ASSERT_EQ(call({"report", place.string()}).code, kDone);
  EXPECT_EQ(contents(place), before);
}

// What CI runs to see that all is well.
TEST(SuiteRun, SmokeMeetsItsExpectations) {
  const Outcome outcome = call({"suite", "smoke", "--quiet", "--out", fresh_folder("suite_smoke").string()});
  EXPECT_EQ(outcome.code, kDone) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace vsslam

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/results/map_file.h"
#include "scenarios/results/metrics.h"
#include "scenarios/run/pending_folder.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = scratch_folder() / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

Metrics some_metrics() {
  Metrics m;
  m.scenario = "s";
  m.method = "lvi-sam";
  m.seed = 18446744073709551615ull;
  m.ate_rmse_m = 0.1 + 0.2;
  m.loops.false_loops = 2;
  m.loops.precision = 0.5;
  m.end_error_m = std::numeric_limits<double>::quiet_NaN();
  return m;
}

TEST(Metrics, EveryBoundableMetricStandsInTheFile) {
  const auto json = nlohmann::json::parse(Metrics{}.json());
  for (const std::string& name : metric_names()) {
    const size_t dot = name.find('.');
    const auto& group = dot == std::string::npos ? json : json.at(name.substr(0, dot));
    EXPECT_TRUE(group.contains(name.substr(dot == std::string::npos ? 0 : dot + 1))) << name;
  }
}

TEST(Metrics, KeepsDoublesToTheBitAndWritesNullForNone) {
  const auto json = nlohmann::json::parse(some_metrics().json());
  EXPECT_EQ(json["ate_rmse_m"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(json["seed"].get<uint64_t>(), 18446744073709551615ull);
  EXPECT_TRUE(json["vio_ate_rmse_m"].is_null());
  EXPECT_TRUE(json["end_error_m"].is_null());
}

TEST(Metrics, ExpectationsTellValueBoundAndPass) {
  Metrics m = some_metrics();
  m.compare({{"ate_rmse_m", {.min = {}, .max = 0.5}},
             {"loops.false", {.min = {}, .max = 0}},
             {"loops.precision", {.min = 0.5, .max = 1}},
             {"loops.recall", {.min = 0, .max = {}}}});
  const auto json = nlohmann::json::parse(m.json())["expectations"];
  EXPECT_EQ(json["ate_rmse_m"], (nlohmann::json{{"value", 0.1 + 0.2}, {"bound", "<= 0.5"}, {"pass", true}}));
  EXPECT_EQ(json["loops.false"], (nlohmann::json{{"value", 2.0}, {"bound", "<= 0"}, {"pass", false}}));
  EXPECT_EQ(json["loops.precision"]["pass"], true);
  EXPECT_EQ(json["loops.recall"], (nlohmann::json{{"value", nullptr}, {"bound", ">= 0"}, {"pass", false}}));
}

TEST(PendingFolder, AppearsWholeOrNotAtAll) {
  const fs::path out = fresh_folder("result_folder");
  const fs::path place = out / "s" / "m" / "seed_1";
  {
    PendingFolder folder(place);
    write_file(folder.path() / "a", "half");
  }
  EXPECT_TRUE(fs::is_empty(place.parent_path()));
  {
    PendingFolder folder(place);
    write_file(folder.path() / "a", "old");
    EXPECT_FALSE(fs::exists(place));
    folder.commit();
  }
  {
    PendingFolder folder(place);
    write_file(folder.path() / "b", "new");
    folder.commit();
  }
  EXPECT_FALSE(fs::exists(place / "a"));
  EXPECT_EQ(read_file(place / "b"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(place.parent_path()), {}), 1);
}

TEST(PendingFolder, LatestPointsAtTheNewest) {
  const fs::path out = fresh_folder("latest");
  for (const char* name : {"one", "two"}) {
    fs::create_directories(out / name);
    link_latest(out, out / name);
    EXPECT_EQ(fs::read_symlink(out / "latest"), name);
  }
}

TEST(MapFile, IsBinaryPlyOfTheSamePoints) {
  const fs::path path = fresh_folder("map_file") / "map.ply";
  const Cloud cloud = {{1.5f, -2.25f, 3.0f}, {0.1f, 0.2f, 0.3f}};
  write_ply(path, cloud);
  const std::string bytes = read_file(path);
  EXPECT_THAT(bytes, ::testing::StartsWith("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(bytes, ::testing::HasSubstr(
                         "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"));
  const std::string end = "end_header\n";
  const size_t data = bytes.find(end) + end.size();
  ASSERT_EQ(bytes.size() - data, 2 * 3 * sizeof(float));
  float values[6];
  std::memcpy(values, bytes.data() + data, sizeof values);
  EXPECT_EQ(values[1], -2.25f);
  EXPECT_EQ(values[5], 0.3f);
}

}  // namespace
}  // namespace vsslam

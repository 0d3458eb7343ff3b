#include "scenarios/report/report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/errors.h"
#include "core/files.h"
#include "core/rng.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/score.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "scenarios/report/base64.h"
#include "scenarios/report/ply_points.h"
#include "scenarios/results/results_columns.h"
#include "slam/lidar/cloud.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double kWidth_m = 42, kDepth_m = 26;

/// Place and heading after `s` metres along a rectangle with sharp corners.
SE3 on_ring(double s) {
  s = std::fmod(s, 2 * (kWidth_m + kDepth_m));
  if (s < kWidth_m) return SE3::from_rpy({0, 0, 0}, {s, 0, 0.3});
  if (s < kWidth_m + kDepth_m)
    return SE3::from_rpy({0, 0, std::numbers::pi / 2}, {kWidth_m, s - kWidth_m, 0.3});
  s -= kWidth_m + kDepth_m;
  if (s < kWidth_m) return SE3::from_rpy({0, 0, std::numbers::pi}, {kWidth_m - s, kDepth_m, 0.3});
  return SE3::from_rpy({0, 0, -std::numbers::pi / 2}, {0, kDepth_m + kWidth_m - s, 0.3});
}

struct Drive {
  PoseTrajectory truth, estimate, odometry;
};

Drive ring_drive(size_t scans, double drift) {
  Drive drive;
  const RandomStream noise(7, "drive");
  for (size_t i = 0; i < scans; ++i) {
    const Time stamp{static_cast<int64_t>(i) * 100'000'000};
    const double s = 0.1 * static_cast<double>(i), turn = drift * 0.002 * s;
    const Vec3 shake = 0.02 * Vec3(noise.normal(i, 0), noise.normal(i, 1), 0.2 * noise.normal(i, 2));
    const SE3 T_map_world = SE3::from_rpy({0, 0, -0.4}, {-2, 1, 0});
    drive.truth.push_back({stamp, on_ring(s)});
    drive.odometry.push_back(
        {stamp, SE3::from_rpy({0, 0, turn}, shake + drift * 0.01 * s * Vec3(1, -0.5, 0)) * T_map_world *
                    on_ring(s)});
    drive.estimate.push_back(
        {stamp, T_map_world *
                    SE3(Quat::Identity(), 0.5 * shake + 0.3 * drift * std::sin(0.05 * s) * Vec3(1, 1, 0)) *
                    on_ring(s)});
  }
  return drive;
}

std::string scans_text(const Drive& drive) {
  CsvWriter csv(kScanColumns);
  const RandomStream noise(7, "scans");
  for (size_t i = 0; i < drive.truth.size(); ++i) {
    const double s = 0.1 * static_cast<double>(i);
    const bool corridor = std::fmod(s, kWidth_m + kDepth_m) > 6 && std::fmod(s, kWidth_m + kDepth_m) < 36;
    const int key = i % 10 == 0 ? static_cast<int>(i / 10) : -1;
    const double weak = (corridor ? 0.002 : 0.12) * std::exp(0.3 * noise.normal(i, 0)), points = 1200;
    const double alpha = 1 - weak / 0.6, revisit = s > 2 * (kWidth_m + kDepth_m) && key >= 0;
    csv(i)(drive.truth[i].stamp)(key)(alpha < 0.98 ? 1 : 0)
        .empty(2)(alpha)(0.97 + 0.02 * noise.uniform(i, 1));
    csv(weak * points)(0.3 * points)(0.6 * points)(Vec3(1, 0.02 * noise.normal(i, 2), 0));
    csv(0.5 * points)(4.0 * points)(9.0 * points)(Vec3(1, 0, 0));
    csv(alpha)(0.98)(weak * 1500 * 0.9)(0.3 * 1500)(0.6 * 1500)(Vec3(1, 0, 0));
    csv(0.5 * 1500)(4.0 * 1500)(9.5 * 1500)(Vec3(1, 0, 0.02))(1500);
    csv(1200)(4)(1)(0)(corridor ? 1 : 0)(weak < 0.01 ? 1 : 0);
    if (revisit)
      csv(key - 136)(key % 7 == 0 ? 0 : 1);
    else
      csv.empty(2);
    csv.end_row();
  }
  return csv.text();
}

void add_loop(CsvWriter& csv, const Drive& drive, size_t query, size_t match, bool accepted,
              const char* verdict, const char* why) {
  csv(query / 10)(match / 10)(drive.truth[query].stamp)(drive.truth[match].stamp)(0.18).empty();
  csv(3)(1.5)(-1.5)(0.1)(1)(1)(17)(0.034)(0.91)(0.77)(accepted)(why);
  csv(SE3())(SE3::from_rpy({0, 0, 0.1}, {1, 0, 0}))(0.12)(0.4)(0.81)(verdict).end_row();
}

std::string loops_text(const Drive& drive) {
  CsvWriter csv(kLoopColumns);
  add_loop(csv, drive, 700, 20, true, "false", "accepted");
  add_loop(csv, drive, 900, 240, false, "rejected", "fitness <0.3>");
  for (size_t query = 1370; query + 1 < drive.truth.size(); query += 40)
    add_loop(csv, drive, query, query - 1360, true, "true", "accepted");
  return csv.text();
}

std::string descriptors_text(const Drive& drive) {
  CsvWriter csv(kDescriptorColumns);
  for (size_t i = 0; i < 1300; i += 130)
    csv(i / 10)(i)(drive.truth[i].stamp)(drive.estimate[i].pose)(5120).end_row();
  return csv.text();
}

std::string map_text(const Drive& drive) {
  std::string points;
  size_t count = 0;
  const RandomStream noise(7, "map");
  for (size_t i = 0; i < 1360 && i < drive.estimate.size(); ++i)
    for (uint64_t k = 0; k < 40; ++k, ++count) {
      const double side = k % 2 == 0 ? 1.2 : -1.2;
      const Vec3 p = drive.estimate[i].pose * Vec3(0.5 * noise.normal(i, 3 * k),
                                                   side + 0.02 * noise.normal(i, 3 * k + 1),
                                                   2.5 * noise.uniform(i, 3 * k + 2));
      for (const float value :
           {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())})
        points.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
             "property float z\nelement camera 1\nproperty float view_px\nend_header\n",
             count) +
         points + std::string(4, '\0');
}

std::string metrics_text(const std::string& method, double ate) {
  return nlohmann::json{
      {"scenario", "corridor_<ring>"},
      {"method", method},
      {"seed", 1},
      {"duration_s", 150.0},
      {"path_length_m", 149.9},
      {"scans", 1500},
      {"images", nullptr},
      {"ate_rmse_m", ate},
      {"ate_max_m", 2 * ate},
      {"rpe_10m_percent", 0.71},
      {"rpe_10m_deg", 0.12},
      {"end_error_m", 0.153},
      {"odometry_ate_rmse_m", 0.912},
      {"map_error_mean_m", 0.021},
      {"descriptors",
       {{"count", 10}, {"index_bytes", 88}, {"descriptor_bytes", 51200}, {"database_bytes", 1234567}}},
      {"loops",
       {{"candidates", 6},
        {"accepted", 5},
        {"true", 4},
        {"false", 1},
        {"revisits", 14},
        {"recall", 0.857},
        {"precision", 0.8}}},
      {"degeneracy", {{"precision", 0.93}, {"recall", 0.99}, {"direction_error_deg_median", 1.2}}},
      {"restarts", 0},
      {"expectations",
       {{"ate_rmse_m", {{"value", ate}, {"bound", "<= 0.5"}, {"pass", true}}},
        {"loops.false", {{"value", 1}, {"bound", "<= 0"}, {"pass", false}}}}}}
      .dump(2);
}

constexpr const char* kTiming =
    R"({"real_time_factor": 14.2, "peak_rss_mib": 312.5, "cores": 2,
        "stages": {"odometry": {"median_ms": 4.21, "p99_ms": 9.7, "count": 1500},
                   "loop <search>": {"median_ms": 0.8, "p99_ms": 41.5, "count": 150}}})";

/// A small result folder with everything in it.
fs::path make_result(const std::string& name, const std::string& method = "lvi-sam", double drift = 1) {
  const fs::path folder = scratch_folder() / name;
  fs::remove_all(folder);
  const Drive drive = ring_drive(1500, drift);
  write_file(folder / "metrics.json", metrics_text(method, 0.18 * drift));
  write_file(folder / "timing.json", kTiming);
  write_tum(folder / "truth.tum", drive.truth);
  write_tum(folder / "estimate.tum", drive.estimate);
  write_tum(folder / "odometry.tum", drive.odometry);
  write_file(folder / "scans.csv", scans_text(drive));
  write_file(folder / "loops.csv", loops_text(drive));
  write_file(folder / "descriptors.csv", descriptors_text(drive));
  write_file(folder / "map.ply", map_text(drive));
  return folder;
}

std::string report_of(const fs::path& folder) {
  write_report(folder);
  return read_file(folder / "report.html");
}

std::string error_of(const fs::path& folder) {
  try {
    write_report(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

nlohmann::json data_of(const std::string& page) {
  const std::string_view open = "<script type=\"application/json\" id=\"data\">";
  const size_t begin = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::vector<float> floats(const nlohmann::json& text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t group = 0;
  int bits = 0;
  for (const char c : text.get<std::string>()) {
    if (c == '=') break;
    group = group << 6 | static_cast<uint32_t>(kDigits.find(c));
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xFF);
  }
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

TEST(Base64, KnownAnswers) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(Report, IsOneSelfContainedPage) {
  const std::string page = report_of(make_result("whole"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy\" content=\"default-src 'none';"));
  EXPECT_THAT(page, AllOf(Not(HasSubstr("http://")), Not(HasSubstr("https://")), Not(HasSubstr(" src=")),
                          Not(HasSubstr("<link"))));
  EXPECT_LT(page.size(), 3u << 20);
  EXPECT_THAT(page, HasSubstr("corridor_&lt;ring&gt; · lvi-sam · seed 1"));
  EXPECT_THAT(page, Not(HasSubstr("<ring>")));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">ATE RMSE</th><td>0.180</td>"));
  EXPECT_THAT(page, HasSubstr("1\u2009234\u2009567"));
  EXPECT_THAT(page, HasSubstr("<span class=\"chip bad\">fail</span>"));
  EXPECT_THAT(page, HasSubstr("fitness &lt;0.3&gt;"));
}

// Names come from files, so they are escaped; results from before there was health have no panel.
TEST(Report, TellsOfTheHealthOfTheSensors) {
  const fs::path folder = make_result("health");
  EXPECT_THAT(report_of(folder), Not(HasSubstr("id=\"health\"")));
  auto metrics = nlohmann::json::parse(read_file(folder / "metrics.json"));
  metrics["health"] = {
      {"sensors",
       {{"imu", {{"used", 15000}, {"dropped", {{"late", 3}}}, {"rate_hz", 100.0}, {"gyro_scale", 57.3}}},
        {"lidar", {{"used", 1500}, {"dropped", nlohmann::json::object()}, {"share_of_time", 0.5}}}}},
      {"scans_prior_only", 900},
      {"scans_unconverged", 2},
      {"lost_spans", {{{"begin_s", 3.0}, {"end_s", 4.5}, {"scans", 16}, {"why", "too few <planes>"}}}},
      {"repairs", {"imu: in <g>"}},
      {"warnings", {"imu: in degrees?"}},
      {"worthless", nullptr}};
  write_file(folder / "metrics.json", metrics.dump());
  EXPECT_THAT(report_of(folder),
              AllOf(HasSubstr("<section id=\"health\">"), HasSubstr("imu: in degrees?"),
                    HasSubstr("imu: in &lt;g&gt;"), HasSubstr("too few &lt;planes&gt;"),
                    HasSubstr("3 <small>late 3</small>"), HasSubstr("gyroscope by LiDAR 57.300"),
                    HasSubstr("1 warning</span>"), HasSubstr("50 %")));
  metrics["health"]["worthless"] = "the LiDAR gave nothing";
  write_file(folder / "metrics.json", metrics.dump());
  EXPECT_THAT(report_of(folder),
              HasSubstr("<span class=\"chip bad\">worthless</span> the LiDAR gave nothing"));
  EXPECT_THAT(report_of(folder), HasSubstr("<td>0.180 <span class=\"chip bad\">!</span></td>"));
}

TEST(Report, DrawsTheErrorThatTheScoreFinds) {
  const fs::path folder = make_result("errors");
  const nlohmann::json run = data_of(report_of(folder))["runs"][0];
  const TrajectoryScore scored = score(read_tum(folder / "estimate.tum"), read_tum(folder / "truth.tum"));
  const std::vector<float> errors = floats(run["estimate"]["error_m"]), times = floats(run["estimate"]["t"]);
  ASSERT_EQ(errors.size(), 1500u);
  for (size_t i = 0; i < errors.size(); ++i) EXPECT_EQ(errors[i], static_cast<float>(scored.errors_m[i]));
  EXPECT_FLOAT_EQ(times.back(), 149.9f);
  EXPECT_NEAR(floats(run["estimate"]["d"]).back(), 149.9, 0.5);
  EXPECT_EQ(run["missed"].size(), 2u);
  EXPECT_EQ(run["loops"][0]["kind"], "false");
  EXPECT_NEAR(run["loops"][0]["from"][1], kDepth_m, 5);  // far from its match at the start
}

TEST(Report, MapPointsLandOnTheTrueWalls) {
  const nlohmann::json map = data_of(report_of(make_result("map", "lvi-sam", 0)))["runs"][0]["map"];
  EXPECT_NEAR(map["origin"][0], -1.3, 0.3);
  EXPECT_NEAR(map["origin"][1], -1.3, 0.3);
  EXPECT_LE(map["xyz"].get<std::string>().size(), 60'000u * 6 * 4 / 3 + 4);
}

TEST(Report, SameFilesSameBytes) {
  const fs::path folder = make_result("bytes");
  const std::string first = report_of(folder);
  EXPECT_EQ(first, report_of(folder));
}

TEST(Report, OnlyTheTimingPanelFollowsTiming) {
  const fs::path folder = make_result("timing");
  const auto without_timing = [](std::string page) {
    const size_t begin = page.find("<!-- timing begin -->"), end = page.find("<!-- timing end -->");
    EXPECT_LT(begin, end);
    EXPECT_NE(end, page.npos);
    return page.erase(begin, end - begin);
  };
  const std::string with = report_of(folder);
  EXPECT_THAT(with,
              AllOf(HasSubstr("Real-time factor"), HasSubstr("loop &lt;search&gt;"), HasSubstr("41.500")));
  write_file(folder / "timing.json", R"({"real_time_factor": 3})");
  const std::string other = report_of(folder);
  fs::remove(folder / "timing.json");
  const std::string none = report_of(folder);
  EXPECT_THAT(none, Not(HasSubstr("Real-time factor")));
  EXPECT_NE(with, other);
  EXPECT_EQ(without_timing(with), without_timing(other));
  EXPECT_EQ(without_timing(with), without_timing(none));
}

TEST(Report, PanelsWithoutDataAreAbsent) {
  const fs::path folder = make_result("sparse");
  for (const char* name :
       {"odometry.tum", "scans.csv", "loops.csv", "descriptors.csv", "map.ply", "timing.json"})
    fs::remove(folder / name);
  const std::string page = report_of(folder);
  const nlohmann::json run = data_of(page)["runs"][0];
  for (const char* part : {"odometry", "scans", "loops", "stored", "map", "weak", "missed"})
    EXPECT_FALSE(run.contains(part)) << part;
  EXPECT_THAT(page, Not(HasSubstr("id=\"loops\"")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"timing\"")));
}

TEST(Report, HeadersWithoutRowsAreFine) {
  const fs::path folder = make_result("headers");
  write_file(folder / "scans.csv", CsvWriter(kScanColumns).text());
  write_file(folder / "loops.csv", CsvWriter(kLoopColumns).text());
  write_file(folder / "descriptors.csv", CsvWriter(kDescriptorColumns).text());
  EXPECT_THAT(report_of(folder), Not(HasSubstr("id=\"loops\"")));
}

TEST(Report, BrokenFilesAreNamed) {
  const auto broken = [](const char* name, const std::string& content) {
    const fs::path folder = make_result("broken");
    write_file(folder / name, content);
    return error_of(folder);
  };
  EXPECT_THAT(broken("metrics.json", ""), HasSubstr("metrics.json"));
  EXPECT_THAT(broken("metrics.json", "[1]"), HasSubstr("metrics.json: expected a JSON object"));
  EXPECT_THAT(broken("metrics.json", "{}"), HasSubstr("metrics.json: \"scenario\""));
  EXPECT_THAT(broken("metrics.json", R"({"scenario":"a","method":"b","seed":1,"expectations":{"x":3}})"),
              HasSubstr("expectation \"x\""));
  EXPECT_THAT(broken("timing.json", "{"), HasSubstr("timing.json"));
  EXPECT_THAT(broken("truth.tum", ""), HasSubstr("truth.tum: no pose"));
  EXPECT_THAT(broken("estimate.tum", "1 2 3\n"), HasSubstr("estimate.tum:1"));
  EXPECT_THAT(broken("estimate.tum", "1e6 0 0 0 0 0 0 1\n"), HasSubstr("estimate.tum and"));
  EXPECT_THAT(broken("odometry.tum", "x\n"), HasSubstr("odometry.tum:1"));
  EXPECT_THAT(broken("scans.csv", ""), HasSubstr("scans.csv:1: empty"));
  EXPECT_THAT(broken("scans.csv", "a,b\n"), HasSubstr("scans.csv:1: missing columns"));
  EXPECT_THAT(broken("loops.csv", CsvWriter(kLoopColumns).text() + "1,2\n"),
              HasSubstr("loops.csv:2: 2 fields"));
  EXPECT_THAT(broken("descriptors.csv", CsvWriter(kDescriptorColumns).text() + "1,2,x,4,5,6,7,8,9,10,11\n"),
              HasSubstr("descriptors.csv"));
  EXPECT_THAT(broken("map.ply", "plx\n"), HasSubstr("map.ply:1: not a PLY file"));
}

TEST(Report, MissingFilesAreNamed) {
  for (const char* name : {"metrics.json", "truth.tum", "estimate.tum"}) {
    const fs::path folder = make_result("missing");
    fs::remove(folder / name);
    EXPECT_THAT(error_of(folder), HasSubstr(name));
  }
  EXPECT_THAT(error_of(scratch_folder() / "no_such_result"), HasSubstr("no_such_result"));
}

TEST(Report, ComparesSideBySide) {
  const std::vector<fs::path> folders = {make_result("one", "lvi-sam", 2),
                                         make_result("two", "sc-lvi-sam", 1)};
  const fs::path html = scratch_folder() / "comparison.html";
  write_comparison(folders, html);
  const std::string page = read_file(html);
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">ATE RMSE</th><td>0.360</td><td class=\"best\">0.180</td>"));
  EXPECT_THAT(page, HasSubstr("corridor_&lt;ring&gt; · 2 results"));
  EXPECT_EQ(data_of(page)["runs"].size(), 2u);
  EXPECT_LT(page.size(), 3u << 20);
  EXPECT_THROW(write_comparison({}, html), InputError);
}

fs::path ply(const std::string& content) {
  const fs::path path = scratch_folder() / "x.ply";
  write_file(path, content);
  return path;
}

std::string ply_error(const std::string& content) {
  try {
    read_ply_points(ply(content));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PlyPoints, SkipsOtherProperties) {
  const Cloud cloud =
      read_ply_points(ply("ply\r\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty uchar "
                          "red\nproperty double z\n"
                          "property float x\nproperty float y\nelement face 1\nproperty list uchar int "
                          "vertex_indices\nend_header\n"
                          "255 3 1 2\n0 -3.5 -1 -2\n3 0 1 0\n"));
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(cloud[1], Eigen::Vector3f(-1, -2, -3.5f));
}

TEST(PlyPoints, BrokenFilesAreErrors) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(ply_error(""), HasSubstr("ends too early"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz), HasSubstr("ends too early"));
  EXPECT_THAT(ply_error("ply\nformat binary_big_endian 1.0\n"), HasSubstr("x.ply:2: format"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement face 1\n"), HasSubstr("first element"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
              HasSubstr("without x, y and z"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n1 2\n"),
              HasSubstr("x.ply:8: 2 values, expected 3"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n1 2 nan\n"),
              HasSubstr("finite"));
  EXPECT_THAT(
      ply_error("ply\nformat ascii 1.0\nelement vertex 9999999999999\n" + xyz + "end_header\n1 2 3\n"),
      HasSubstr("9999999999999 vertices announced"));
  EXPECT_THAT(ply_error("ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + xyz +
                        "end_header\n012345678901"),
              HasSubstr("ends within its vertices"));
}

}  // namespace
}  // namespace vsslam

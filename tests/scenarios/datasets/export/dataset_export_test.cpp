// Whole exports of a small room: contents, repeatability, resuming, stopping, mistakes.
#include "scenarios/datasets/export/dataset_export.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/datasets/facts/rig_sheet.h"
#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "tests/scenarios/command_line.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Exports the small room, 1.5 s of it, into a folder of the scratch.
Outcome export_room(const std::string& name, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {
      "export", "quick_room", "--set", "max_duration_s=1.5", "--out", (scratch_folder() / name).string(),
      "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return call(arguments);
}

// Every file below a folder with its bytes, but for what names the export itself.
std::map<std::string, std::string> content(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

void expect_same(const fs::path& a, const fs::path& b) {
  const auto first = content(a), second = content(b);
  std::vector<std::string> names, others;
  for (const auto& [name, bytes] : first) names.push_back(name);
  for (const auto& [name, bytes] : second) others.push_back(name);
  ASSERT_EQ(names, others);
  for (const auto& [name, bytes] : first) EXPECT_TRUE(bytes == second.at(name)) << name;
}

const std::vector<std::string> kSmallCamera = {"--with", "camera",
                                               "--set",  "rig.sensors.camera.width_px=64",
                                               "--set",  "rig.sensors.camera.height_px=48",
                                               "--set",  "rig.sensors.camera.cx_px=31.5",
                                               "--set",  "rig.sensors.camera.cy_px=23.5"};

std::vector<std::string> with_small_camera(std::vector<std::string> more) {
  more.insert(more.end(), kSmallCamera.begin(), kSmallCamera.end());
  return more;
}

TEST(Export, ABagHasEveryTopicInOrder) {
  const Outcome outcome = export_room("bag", {"--format", "bag,pcd", "--json"});
  ASSERT_EQ(outcome.code, kDone) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  const int64_t scans = json["scans"].get<int64_t>();
  EXPECT_NEAR(static_cast<double>(scans), 15, 1);  // the last one may just not end in time
  EXPECT_EQ(json["imu"].get<int64_t>(), 151);
  EXPECT_EQ(json["wheels"].get<int64_t>(), 76);

  const fs::path folder = scratch_folder() / "bag";
  const auto reader = read_messages(folder / "quick_room.bag");
  std::map<std::string, int64_t> count;
  int64_t scan = 0;
  Time before{0};
  while (const auto message = reader->next()) {
    EXPECT_GE(message->recorded, before);
    before = message->recorded;
    ++count[message->topic];
    if (const auto* cloud = std::get_if<PointCloudMessage>(&message->content)) {
      const std::string pcd = read_file(folder / "pcd" / fmt::format("{:06}.pcd", scan++));
      ASSERT_GT(pcd.size(), cloud->data.size());
      EXPECT_EQ(
          std::memcmp(pcd.data() + pcd.size() - cloud->data.size(), cloud->data.data(), cloud->data.size()),
          0);
      float last_time_s = 0;
      std::memcpy(&last_time_s, cloud->data.data() + cloud->data.size() - 4, 4);
      EXPECT_NEAR(seconds_between(cloud->header.stamp, message->recorded), last_time_s, 2e-4);
    }
    if (const auto* imu = std::get_if<ImuMessage>(&message->content)) {
      EXPECT_GE(imu->orientation_covariance[0], 0);
      EXPECT_EQ(imu->header.stamp, message->recorded);
    }
  }
  EXPECT_EQ(count["/velodyne_points"], scans);
  EXPECT_EQ(count["/truth/odometry"], scans);
  EXPECT_EQ(count["/imu/data"], 151);
  EXPECT_EQ(count["/joint_states"], 76);
  EXPECT_EQ(count["/odom"], 76);
  EXPECT_EQ(count["/tf_static"], 1);
  EXPECT_EQ(count.size(), 6u);
  EXPECT_EQ(read_tum(folder / "truth.tum").size(), static_cast<size_t>(scans));
}

TEST(Export, DescribesItself) {
  ASSERT_EQ(export_room("described", {"--for", "lio-sam"}).code, kDone);
  const fs::path folder = scratch_folder() / "described";
  const std::string readme = read_file(folder / "README.md");
  for (const char* text :
       {"# quick_room", "/points_raw", "roslaunch lio_sam run.launch", "rosbag play quick_room.bag",
        "`lio_sam/params.yaml`", "./vsslam replay .", "1700000000 s since 1970"})
    EXPECT_THAT(readme, HasSubstr(text));
  RigSheet sheet;
  load_config(folder / "rig.yaml", sheet);
  EXPECT_EQ(sheet.topics.lidar, "/points_raw");
  EXPECT_EQ(sheet.topics.wheels, "/joint_states");
  EXPECT_EQ(sheet.topics.camera, "");
  const Scenario scenario = load_scenario((folder / "scenario.yaml").string());
  EXPECT_EQ(scenario.max_duration_s, 1.5);
  EXPECT_EQ(scenario.rig.mounts.lidar.T_base_sensor().rotation.coeffs(),
            sheet.calibration.lidar.T_base_lidar.rotation.coeffs());
}

TEST(Export, SameBytesForAnyNumberOfThreads) {
  const std::vector<std::string> all =
      with_small_camera({"--format", "bag,mcap,euroc,kitti,pcd,ply,tum", "--threads", "1"});
  std::vector<std::string> two = all;
  two[3] = "2";
  ASSERT_EQ(export_room("one_thread", all).code, kDone);
  ASSERT_EQ(export_room("two_threads", two).code, kDone);
  expect_same(scratch_folder() / "one_thread", scratch_folder() / "two_threads");
}

// What a killed export leaves: some files whole, one in the making, no tables.
TEST(Export, ResumesToTheSameBytes) {
  const std::vector<std::string> formats = with_small_camera({"--format", "euroc,kitti,pcd"});
  ASSERT_EQ(export_room("whole", formats).code, kDone);
  ASSERT_EQ(export_room("resumed", formats).code, kDone);
  const fs::path folder = scratch_folder() / "resumed";
  fs::rename(folder / ".export-complete", folder / ".export-begun");
  int removed = 0;
  for (const auto& [name, bytes] : content(folder))
    if (!name.starts_with('.') && (name.ends_with(".csv") || name.ends_with(".txt") || removed % 2 == 0))
      fs::remove(folder / name), ++removed;
    else
      ++removed;
  write_file(folder / "pcd" / "000009.pcd.part123", "half");
  fs::remove(folder / "README.md");
  const Outcome refused = export_room("resumed", formats);
  EXPECT_EQ(refused.code, kBadInput);
  EXPECT_THAT(refused.err, HasSubstr("an unfinished export (--resume goes on"));
  std::vector<std::string> resume = formats;
  resume.emplace_back("--resume");
  const Outcome outcome = export_room("resumed", resume);
  ASSERT_EQ(outcome.code, kDone) << outcome.err;
  expect_same(scratch_folder() / "whole", folder);
  const Outcome again = export_room("resumed", resume);
  EXPECT_EQ(again.code, kDone);
  EXPECT_THAT(again.out, HasSubstr("complete already"));
}

TEST(Export, OldDatasetsAreNotReplacedUnasked) {
  ASSERT_EQ(export_room("old", {"--format", "ply"}).code, kDone);
  const Outcome exists = export_room("old", {"--format", "ply"});
  EXPECT_EQ(exists.code, kBadInput);
  EXPECT_THAT(exists.err, HasSubstr("exists already (--overwrite makes it anew)"));
  const Outcome other = export_room("old", {"--format", "ply", "--seed", "2", "--resume"});
  EXPECT_EQ(other.code, kBadInput);
  EXPECT_THAT(other.err, HasSubstr("other settings"));
  EXPECT_EQ(export_room("old", {"--format", "ply", "--seed", "2", "--overwrite"}).code, kDone);
  write_file(scratch_folder() / "mine" / "thesis.txt", "precious");
  const Outcome mine = export_room("mine", {"--format", "ply", "--overwrite"});
  EXPECT_EQ(mine.code, kBadInput);
  EXPECT_THAT(mine.err, HasSubstr("something else than a dataset"));
  EXPECT_EQ(read_file(scratch_folder() / "mine" / "thesis.txt"), "precious");
}

TEST(Export, TruthFilesCoverEveryScanAndSample) {
  std::vector<std::string> arguments = kSmallCamera;
  arguments[1] = "camera,points,clean,depth,labels,biases,loops,degeneracy";
  arguments.insert(arguments.end(), {"--format", "pcd"});
  const Outcome outcome = export_room("truths", arguments);
  ASSERT_EQ(outcome.code, kDone) << outcome.err;
  const fs::path truth = scratch_folder() / "truths" / "truth";
  const auto files_in = [&](const char* name) {
    return std::distance(fs::directory_iterator(truth / name), fs::directory_iterator());
  };
  const auto scans = files_in("points");
  EXPECT_NEAR(static_cast<double>(scans), 15, 1);
  EXPECT_EQ(files_in("clean"), scans);
  EXPECT_EQ(files_in("labels"), scans);
  EXPECT_EQ(files_in("depth"), files_in("clean_images"));
  EXPECT_GE(files_in("depth"), 43);
  EXPECT_EQ(CsvTable::read(truth / "degeneracy.csv").rows(), static_cast<size_t>(scans));
  EXPECT_EQ(CsvTable::read(truth / "imu.csv").rows(), 151u);
  EXPECT_EQ(CsvTable::read(truth / "wheels.csv").rows(), 76u);
  const CsvTable keys = CsvTable::read(truth / "key_scans.csv");
  ASSERT_EQ(keys.rows(), 1u);  // the robot rests
  EXPECT_EQ(keys.integer(0, "scan"), 0);
  EXPECT_EQ(CsvTable::read(truth / "loops.csv").rows(), 0u);
  // One label per point.
  const std::string pcd = read_file(scratch_folder() / "truths" / "pcd" / "000003.pcd");
  const size_t points = (pcd.size() - pcd.find("DATA binary\n") - 12) / 22;
  EXPECT_EQ(fs::file_size(truth / "labels" / "000003.label"), 4 * points);
  EXPECT_GT(CsvTable::read(truth / "label_names.csv").rows(), 3u);
}

// Stops the export in the middle, as Ctrl-C would.
class StoppingSink final : public DatasetSink {
 public:
  StoppingSink(std::atomic<bool>& stop, bool fail) : stop_(stop), fail_(fail) {}
  bool needs_scan(int64_t, Time) const override { return true; }
  bool needs_image(Time) const override { return true; }
  void write(const DatasetSample& sample) override {
    if (!std::holds_alternative<LidarMeasurement>(sample.measurement) || sample.index < 3) return;
    if (fail_) throw ResourceError("no space left");
    stop_ = true;
  }
  void finish() override { ADD_FAILURE() << "finished although stopped"; }

 private:
  std::atomic<bool>& stop_;
  bool fail_;
};

TEST(Export, StoppedOrOutOfSpaceNothingIsFinished) {
  for (const bool fail : {false, true}) {
    Scenario scenario = load_scenario("quick_room");
    scenario.max_duration_s = 1.5;
    ScenarioWorld place(scenario);
    std::atomic<bool> stop{false};
    std::vector<std::unique_ptr<DatasetSink>> sinks;
    std::ostringstream ignored;
    WallClock clock;
    Progress progress(Progress::Style::none, ignored, clock, "");
    sinks.push_back(std::make_unique<StoppingSink>(stop, fail));
    if (fail)
      EXPECT_THROW(run_export(place, sinks, 2, stop, progress), ResourceError);
    else
      EXPECT_THROW(run_export(place, sinks, 2, stop, progress), Interrupted);
  }
}

// A limit on the size of files stands for a disk that is full.
TEST(Export, AFullDiskEndsItWithCode3AndNoFile) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto signal_before = std::signal(SIGXFSZ, SIG_IGN);
  for (const std::string format : {"bag", "mcap", "ply"}) {
    const rlimit small{100'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const Outcome outcome = export_room("full_" + format, {"--format", format});
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(outcome.code, kStopped) << format;
    EXPECT_THAT(outcome.err, HasSubstr("write failed")) << format;
    for (const auto& [name, bytes] : content(scratch_folder() / ("full_" + format)))
      EXPECT_EQ(name, ".export-begun");
  }
  std::signal(SIGXFSZ, signal_before);
}

TEST(Export, SystemsDecideAboutTheCamera) {
  const auto plan = [](const std::string& system, const std::string& with = "") {
    return plan_export({.scenario = "quick_room_vio", .system = system, .with = with});
  };
  EXPECT_FALSE(plan("lio-sam").facts.has_camera());
  EXPECT_THAT(plan("lio-sam").notes, ::testing::ElementsAre(HasSubstr("LIO-SAM uses no camera")));
  EXPECT_TRUE(plan("lio-sam", "camera").facts.has_camera());
  EXPECT_TRUE(plan("").facts.has_camera());
  ExportRequest blind{.scenario = "quick_room", .system = "openvins"};
  EXPECT_TRUE(plan_export(blind).facts.has_camera());
  EXPECT_THAT(plan_export(blind).notes, ::testing::ElementsAre(HasSubstr("OpenVINS needs a camera")));
  EXPECT_EQ(plan_export(blind).facts.folder, "out/datasets/quick_room-openvins");
  const ExportPlan gyro = plan_export({.scenario = "quick_room",
                                       .overrides = {{"rig.sensors.imu.orientation", "false"}},
                                       .system = "lvi-sam"});
  EXPECT_TRUE(gyro.facts.scenario.rig.sensors.imu.orientation);
  EXPECT_THAT(gyro.notes, ::testing::Contains(HasSubstr("needs the IMU's orientation")));
  // LVI-SAM's code knows one mount of the IMU: x back, y left, z down.
  EXPECT_THAT(gyro.notes,
              ::testing::Contains(HasSubstr("one mount of the IMU only: rpy_deg is [0, 180, 0]")));
  EXPECT_TRUE(gyro.facts.rig.imu.T_base_imu.matrix3().isApprox(Mat3(Vec3(-1, 1, -1).asDiagonal()), 1e-12));
  EXPECT_TRUE(plan("lio-sam").facts.rig.imu.T_base_imu.matrix3().isIdentity());
  EXPECT_EQ(plan("orb-slam3").formats, std::vector{DatasetFormat::euroc});
}

TEST(Export, MistakesAreCode2WithOneLine) {
  const auto error = [](std::vector<std::string> more) {
    const Outcome outcome = export_room("mistakes", std::move(more));
    EXPECT_EQ(outcome.code, kBadInput);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error({"--for", "lvi-sma"}), HasSubstr("did you mean lvi-sam?"));
  EXPECT_THAT(error({"--format", "bagg"}), HasSubstr("did you mean bag?"));
  EXPECT_THAT(error({"--with", "dept"}), HasSubstr("did you mean depth?"));
  EXPECT_THAT(error({"--seed", "1-3"}), HasSubstr("expected one number"));
  EXPECT_THAT(error({"--resume", "--overwrite"}), HasSubstr("exclude each other"));
  EXPECT_FALSE(fs::exists(scratch_folder() / "mistakes"));
}

}  // namespace
}  // namespace vsslam

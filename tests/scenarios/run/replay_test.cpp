#include "scenarios/run/replay.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/files.h"
#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/datasets/import/decoders/cloud_decoder.h"
#include "scenarios/datasets/messages/sample_messages.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "scenarios/experiment/library_files.h"
#include "scenarios/experiment/scenario_world.h"
#include "scenarios/stages/driving.h"
#include "scenarios/stages/sensing.h"
#include "tests/scenarios/command_line.h"
#include "tests/scratch.h"
#include "tests/shared_data.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr Duration kEpoch{1'700'000'000'000'000'000};
const MessageNames kNames;

/// Four seconds in a room.
const Scenario& scenario() {
  static const Scenario loaded = load_scenario(
      "quick_room", {Override::parse("max_duration_s=4"), Override::parse("world.room.textures=false"),
                     Override::parse("drive.steps.0.rest.duration_s=0.5")});
  return loaded;
}

struct RecordedDrive {
  std::vector<Message> messages;
  std::vector<StampedPose> truth_world_base;
  RigSheet sheet;
};

const RecordedDrive& recorded_drive() {
  static const RecordedDrive drive = [] {
    RecordedDrive made;
    made.sheet.calibration = calibration_of(scenario());
    ScenarioWorld place(scenario());
    Driving driving(scenario(), place.world(), nullptr);
    Sensing sensing(scenario(), place.world(), 1, nullptr);
    const auto put = [&](const std::string& topic, Time end, auto content) {
      content.header.stamp = content.header.stamp + kEpoch;
      made.messages.push_back({topic, end + kEpoch, std::move(content)});
    };
    while (!driving.ended()) {
      const Motion motion = driving.next(std::nullopt, sensing.needed_from());
      const Chunk chunk = sensing.next(motion);
      size_t scans = 0;
      for (const Measurement& m : chunk.measurements) {
        if (const auto* imu = std::get_if<ImuMeasurement>(&m))
          put(kNames.imu, imu->sample.stamp, imu_message(imu->sample, {1, 1, 1, 1}, "imu"));
        if (const auto* wheels = std::get_if<WheelMeasurement>(&m))
          put(kNames.joints, wheels->sample.stamp, joint_message(wheels->sample, "base"));
        if (const auto* lidar = std::get_if<LidarMeasurement>(&m)) {
          put(kNames.points, lidar->scan.end, cloud_message(lidar->scan, "lidar"));
          made.truth_world_base.push_back({lidar->scan.stamp + kEpoch, chunk.scans[scans++].T_world_base});
        }
      }
    }
    return made;
  }();
  return drive;
}

/// A folder with the drive as drive.bag (or .mcap), the rig's sheet and truth.tum.
fs::path dataset(const std::string& name, bool bag = true, const std::function<bool(Message&)>& keep = {}) {
  const fs::path folder = scratch_folder() / name;
  fs::create_directories(folder);
  const auto writer = bag ? write_bag(folder / "drive.bag") : write_mcap(folder / "drive.mcap");
  for (Message message : recorded_drive().messages)
    if (!keep || keep(message)) writer->write(message);
  writer->finish();
  write_file(folder / "rig.yaml", save_config(recorded_drive().sheet));
  write_tum(folder / "truth.txt", recorded_drive().truth_world_base);
  return folder;
}

Outcome replay(const fs::path& recording, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"replay", recording.string(), "--out",
                                        (scratch_folder() / "runs").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return call(arguments);
}

fs::path result(const std::string& name) {
  return scratch_folder() / "runs" / name / "vs-slam" / "replay";
}

nlohmann::json json_of(const fs::path& path) {
  return nlohmann::json::parse(read_file(path));
}

std::string kitti_of(const LidarScan& scan) {
  std::string bytes;
  for (const LidarPoint& p : scan.points)
    for (const float value : {p.x, p.y, p.z, p.intensity / 255})
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  return bytes;
}

/// Points of our own layout, as the cloud has them.
std::string pcd_of(const PointCloudMessage& cloud) {
  return fmt::format(
             "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\nTYPE F F F F U "
             "F\n"
             "COUNT 1 1 1 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
             cloud.width) +
         std::string(cloud.data.begin(), cloud.data.end());
}

double furthest_apart_m(const PoseTrajectory& a, const PoseTrajectory& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, (a[i].pose.translation - b[i].pose.translation).norm());
  return most;
}

TEST(Replay, GivesTheTrajectoryOfTheRunInTheLoop) {
  const fs::path file = scratch_folder() / "loop.yaml", out = scratch_folder() / "runs";
  Scenario in_the_loop = scenario();
  in_the_loop.name = "loop";
  write_file(file, save_config(in_the_loop));
  ASSERT_EQ(call({"run", file.string(), "--out", out.string(), "--quiet"}).code, 0);
  ASSERT_EQ(replay(dataset("same") / "drive.bag", {"--name", "same"}).code, 0);
  const PoseTrajectory loop = read_tum(out / "loop" / "vs-slam" / "seed_1" / "estimate.tum"),
                       again = read_tum(result("same") / "estimate.tum");
  EXPECT_EQ(furthest_apart_m(loop, again), 0);
  EXPECT_EQ(again[0].stamp - loop[0].stamp, kEpoch);
  EXPECT_TRUE(read_file(out / "loop" / "vs-slam" / "seed_1" / "map.ply") ==
              read_file(result("same") / "map.ply"));
}

TEST(Replay, BytesDoNotDependOnThreadsNorOnTheFormat) {
  const fs::path bag = dataset("bytes"), mcap = dataset("bytes_mcap", false);
  ASSERT_EQ(replay(bag, {"--name", "one", "--threads", "1"}).code, 0);
  ASSERT_EQ(replay(bag, {"--name", "two", "--threads", "2"}).code, 0);
  ASSERT_EQ(replay(mcap, {"--name", "mcap", "--threads", "2"}).code, 0);
  for (const char* file : {"estimate.tum", "odometry.tum", "scans.csv", "loops.csv", "descriptors.csv",
                           "pose_graph.g2o", "map.ply", "recording.json", "replay.yaml", "rig.yaml"}) {
    EXPECT_TRUE(read_file(result("one") / file) == read_file(result("two") / file)) << file;
    if (std::string(file) == "recording.json") continue;
    EXPECT_TRUE(read_file(result("one") / file) == read_file(result("mcap") / file)) << file;
  }
}

TEST(Replay, WithoutTruthNothingIsScored) {
  const Outcome outcome = replay(dataset("no_truth"), {"--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json metrics = json_of(result("no_truth") / "metrics.json");
  EXPECT_EQ(nlohmann::json::parse(outcome.out)[0], metrics);
  for (const char* key :
       {"seed", "ate_rmse_m", "path_length_m", "end_error_m", "map_error_mean_m", "degeneracy"})
    EXPECT_FALSE(metrics.contains(key)) << key;
  for (const char* key : {"true", "false", "precision", "recall", "revisits", "aliases"})
    EXPECT_FALSE(metrics["loops"].contains(key)) << key;
  EXPECT_GT(metrics["scans"], 30);
  EXPECT_FALSE(fs::exists(result("no_truth") / "truth.tum"));
  const std::string page = read_file(result("no_truth") / "report.html");
  EXPECT_THAT(page, AllOf(HasSubstr("There is no truth"), HasSubstr("id=\"error\" hidden")));
  EXPECT_THAT(page, Not(HasSubstr("seed")));
  const nlohmann::json recording = json_of(result("no_truth") / "recording.json");
  EXPECT_EQ(recording["prior"], "wheel_imu");
  EXPECT_EQ(recording["epoch_s"], 1'700'000'000);
  EXPECT_EQ(recording["samples"]["lidar"]["used"], metrics["scans"]);
}

TEST(Replay, WithTruthTheScoreIsThatOfEvaluate) {
  const fs::path folder = dataset("scored");
  const std::string truth = (folder / "truth.txt").string();
  ASSERT_EQ(replay(folder, {"--truth", truth}).code, 0);
  const nlohmann::json metrics = json_of(result("scored") / "metrics.json");
  const Outcome evaluated = call({"evaluate", (result("scored") / "estimate.tum").string(), truth, "--json"});
  EXPECT_NEAR(metrics["ate_rmse_m"].get<double>(),
              nlohmann::json::parse(evaluated.out)["ate_rmse_m"].get<double>(), 1e-8);
  EXPECT_LT(metrics["ate_rmse_m"], 0.02);
  EXPECT_TRUE(metrics["loops"].contains("precision"));
  EXPECT_FALSE(metrics["loops"].contains("recall"));
  EXPECT_THAT(read_file(result("scored") / "report.html"), Not(HasSubstr("id=\"error\" hidden")));
}

TEST(Replay, TakesTheTruthOfADatasetAndSaysWhereNoneFits) {
  const fs::path folder = dataset("truths");
  std::vector<StampedPose> truth = recorded_drive().truth_world_base;
  write_tum(folder / "truth.tum", truth);
  ASSERT_EQ(replay(folder).code, 0);
  EXPECT_EQ(json_of(result("truths") / "recording.json")["truth"], "truth.tum");
  EXPECT_TRUE(json_of(result("truths") / "metrics.json").contains("ate_rmse_m"));
  ASSERT_EQ(replay(folder, {"--topic", "truth=none", "--name", "unjudged"}).code, 0);
  EXPECT_FALSE(fs::exists(result("unjudged") / "truth.tum"));
  for (StampedPose& pose : truth) pose.stamp = pose.stamp - kEpoch;
  write_tum(folder / "truth.tum", truth);
  const Outcome outcome = replay(folder);
  ASSERT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("truth.tum has no pose during the recording"));
  EXPECT_FALSE(json_of(result("truths") / "metrics.json").contains("ate_rmse_m"));
}

TEST(Replay, EverySheetOfTheLibraryLoads) {
  for (const std::string& name : library_names("sheets")) {
    RigSheet sheet;
    EXPECT_NO_THROW(load_config(library_file("sheets", name), sheet, library())) << name;
  }
  RigSheet m2dgr;
  load_config(library_file("sheets", "m2dgr"), m2dgr, library());
  // Its camera looks ahead: z of the camera is x of the base, x of the camera is -y.
  const SE3& T_base_camera = m2dgr.calibration.camera.T_base_camera;
  EXPECT_LT((T_base_camera.rotation * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((T_base_camera.rotation * Vec3::UnitX() + Vec3::UnitY()).norm(), 1e-12);
}

// One plane in 150 of what this unit sees of the room is level: by the LiDAR alone the height is known to
// 7 mm / sqrt(0.8) in each scan, and three sigma are bounded. What is seen well stays where it is.
TEST(Replay, ARealLidarAtRestStaysWhereItIs) {
  const auto packets = shared_packets();
  if (packets.empty()) GTEST_SKIP() << "set VSSLAM_VLP16_PACKETS to a file of raw packets";
  ASSERT_EQ(replay(packets, {"--rig", "vlp16_only", "--name", "real"}).code, 0);
  // A small room: as fine as it takes to find surfaces in it.
  EXPECT_LT(json_of(result("real") / "metrics.json")["health"]["voxel_m"], 0.2);
  for (const StampedPose& pose : read_tum(result("real") / "estimate.tum")) {
    EXPECT_LT(pose.pose.translation.norm(), 0.004);
    EXPECT_LT(pose.pose.angle(), 0.004);
  }
}

TEST(Replay, ChoosesThePriorByWhatIsThere) {
  const auto prior_without = [](const std::string& name, const std::vector<std::string>& topics) {
    const fs::path folder = dataset(name, true, [&](const Message& message) {
      return std::find(topics.begin(), topics.end(), message.topic) == topics.end();
    });
    EXPECT_EQ(replay(folder).code, 0);
    EXPECT_LT(
        furthest_apart_m(read_tum(result(name) / "estimate.tum"), read_tum(result("all") / "estimate.tum")),
        0.05);
    return json_of(result(name) / "recording.json")["prior"];
  };
  ASSERT_EQ(replay(dataset("all")).code, 0);
  EXPECT_EQ(prior_without("imu_only", {kNames.joints}), "imu");
  EXPECT_EQ(prior_without("wheels_only", {kNames.imu}), "wheel");
  EXPECT_EQ(prior_without("lidar_only", {kNames.imu, kNames.joints}), "constant_velocity");
  EXPECT_EQ(prior_for({true, true, true, true}), PriorKind::vio);
  ASSERT_EQ(replay(scratch_folder() / "all", {"--name", "asked", "--set", "slam.prior=wheel"}).code, 0);
  EXPECT_EQ(json_of(result("asked") / "recording.json")["prior"], "wheel");
}

TEST(Replay, GoesOnAfterAGap) {
  const fs::path folder = dataset("gap", false, [](const Message& message) {
    const double s = seconds_between(Time{kEpoch.ns}, message.recorded);
    return message.topic != kNames.points || s < 2 || s > 2.6;
  });
  const Outcome outcome = replay(folder);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("lidar: gaps in the recording, the first after 170000000"));
  const nlohmann::json lidar = json_of(result("gap") / "recording.json")["samples"]["lidar"];
  EXPECT_EQ(lidar["gaps"], 1);
  const PoseTrajectory estimate = read_tum(result("gap") / "estimate.tum");
  EXPECT_NEAR((estimate.back().pose.translation - estimate.front().pose.translation).norm(),
              (recorded_drive().truth_world_base.back().pose.translation -
               recorded_drive().truth_world_base.front().pose.translation)
                  .norm(),
              0.03);
}

TEST(Replay, SalvagesWhatIsBeforeTheBreak) {
  const fs::path whole = dataset("whole") / "drive.bag", cut = scratch_folder() / "cut" / "drive.bag";
  const std::string bytes = read_file(whole);
  write_file(cut, bytes.substr(0, bytes.size() * 2 / 3));
  write_file(cut.parent_path() / "rig.yaml", save_config(recorded_drive().sheet));
  const Outcome broken = replay(cut);
  EXPECT_EQ(broken.code, 2);
  EXPECT_THAT(broken.err, HasSubstr("drive.bag"));
  const Outcome salvaged = replay(cut, {"--salvage", "--name", "cut"});
  ASSERT_EQ(salvaged.code, 0) << salvaged.err;
  EXPECT_THAT(salvaged.err, HasSubstr("damaged"));
  EXPECT_GT(json_of(result("cut") / "metrics.json")["scans"], 5);
}

TEST(Replay, ReadsFoldersOfScansWithEurocsImu) {
  const fs::path folder = scratch_folder() / "euroc";
  std::string table = "file,stamp_ns,end_ns\n", imu = "#timestamp [ns],w,w,w,a,a,a\n";
  for (const Message& message : recorded_drive().messages) {
    if (const auto* sample = std::get_if<ImuMessage>(&message.content))
      imu += fmt::format("{},{},{},{},{},{},{}\r\n", sample->header.stamp.ns, sample->angular_velocity.x(),
                         sample->angular_velocity.y(), sample->angular_velocity.z(),
                         sample->linear_acceleration.x(), sample->linear_acceleration.y(),
                         sample->linear_acceleration.z());
    if (const auto* cloud = std::get_if<PointCloudMessage>(&message.content)) {
      const int64_t ns = cloud->header.stamp.ns;
      table += fmt::format("{0}.pcd,{0},{1}\n", ns, message.recorded.ns);
      write_file(folder / "pcd" / fmt::format("{}.pcd", ns), pcd_of(*cloud));
    }
  }
  write_file(folder / "pcd" / "times.csv", table);
  write_file(folder / "mav0" / "imu0" / "data.csv", imu);
  write_file(folder / "rig.yaml", save_config(recorded_drive().sheet));
  ASSERT_EQ(replay(folder).code, 0);
  dataset("no_wheels", true, [](const Message& message) { return message.topic != kNames.joints; });
  ASSERT_EQ(replay(scratch_folder() / "no_wheels").code, 0);
  EXPECT_TRUE(read_file(result("euroc") / "map.ply") == read_file(result("no_wheels") / "map.ply"));
}

/// The drive with each cloud as `parts` clouds, as drivers send packets or quarters of a turn: stamped at their first points.
fs::path in_parts(const std::string& name, size_t parts) {
  const fs::path folder = dataset(name, true);
  const auto writer = write_bag(folder / "drive.bag");
  for (const Message& message : recorded_drive().messages) {
    const auto* cloud = std::get_if<PointCloudMessage>(&message.content);
    if (cloud == nullptr) {
      writer->write(message);
      continue;
    }
    const LidarScan scan = CloudDecoder({}).decode(*cloud, "");
    for (size_t i = 0; i < parts; ++i) {
      const float begin_s = 0.1f * static_cast<float>(i) / static_cast<float>(parts),
                  end_s = 0.1f * static_cast<float>(i + 1) / static_cast<float>(parts);
      LidarScan part{.stamp = scan.stamp + Duration::from_seconds(begin_s), .end = {}, .points = {}};
      for (LidarPoint p : scan.points)
        if (p.time_s >= begin_s && p.time_s < end_s) p.time_s -= begin_s, part.points.push_back(p);
      writer->write(
          {message.topic, scan.stamp + Duration::from_seconds(end_s), cloud_message(part, "lidar")});
    }
  }
  writer->finish();
  return folder;
}

TEST(Replay, PutsPartsOfTurnsTogether) {
  for (const size_t parts : {2u, 4u, 75u}) {
    const std::string name = fmt::format("parts_{}", parts);
    const fs::path folder = in_parts(name, parts);
    const Outcome outcome = replay(folder, {"--truth", (folder / "truth.txt").string()});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("clouds are parts of turns"));
    const nlohmann::json lidar = json_of(result(name) / "recording.json")["samples"]["lidar"];
    EXPECT_NEAR(lidar["used"].get<double>(), static_cast<double>(recorded_drive().truth_world_base.size()),
                2);
    EXPECT_LT(json_of(result(name) / "metrics.json")["ate_rmse_m"], 0.02) << parts;
  }
}

/// The drive with the rings that these become.
fs::path with_rings(const std::string& name, const std::function<int(const LidarPoint&)>& ring_of) {
  return dataset(name, true, [&](Message& message) {
    if (auto* cloud = std::get_if<PointCloudMessage>(&message.content)) {
      LidarScan scan = CloudDecoder({}).decode(*cloud, "");
      for (LidarPoint& p : scan.points) p.ring = static_cast<uint16_t>(ring_of(p));
      *cloud = cloud_message(scan, "lidar");
      cloud->header.stamp = scan.stamp;
    }
    return true;
  });
}

TEST(Replay, RingsThatSayNothingOrAreMoreThanTheSheetsAreNoError) {
  const auto error_m = [](const fs::path& folder, const char* note) {
    const Outcome outcome = replay(folder, {"--truth", (folder / "truth.txt").string()});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(note));
    return json_of(result(folder.filename()) / "metrics.json")["ate_rmse_m"].get<double>();
  };
  EXPECT_LT(error_m(with_rings("zero", [](const LidarPoint&) { return 0; }), "says nothing"), 0.02);
  EXPECT_LT(error_m(with_rings("wild", [](const LidarPoint& p) { return p.ring + 5000; }), "says nothing"),
            0.02);
  const fs::path doubled = with_rings("doubled", [](const LidarPoint& p) { return 2 * p.ring + 1; });
  EXPECT_LT(error_m(doubled, "points of 32 rings, but the rig's sheet has 16"), 0.02);
}

fs::path kitti_folder(const std::string& name) {
  const fs::path folder = scratch_folder() / name;
  std::string times;
  int scans = 0;
  for (const Message& message : recorded_drive().messages)
    if (const auto* cloud = std::get_if<PointCloudMessage>(&message.content)) {
      const LidarScan scan = CloudDecoder({}).decode(*cloud, "");
      times += fmt::format("{}\n", 0.1 * scans);
      write_file(folder / "velodyne" / fmt::format("{:06}.bin", scans++), kitti_of(scan));
    }
  write_file(folder / "times.txt", times);
  write_file(folder / "rig.yaml", save_config(recorded_drive().sheet));
  return folder;
}

TEST(Replay, ReadsKittiFolders) {
  ASSERT_EQ(replay(kitti_folder("kitti_scans"), {"--set", "slam.prior=constant_velocity"}).code, 0);
  const PoseTrajectory estimate = read_tum(result("kitti_scans") / "estimate.tum");
  ASSERT_EQ(estimate.size(), recorded_drive().truth_world_base.size());
  EXPECT_NEAR((estimate.back().pose.translation - estimate.front().pose.translation).norm(),
              (recorded_drive().truth_world_base.back().pose.translation -
               recorded_drive().truth_world_base.front().pose.translation)
                  .norm(),
              0.03);
}

// Poses of a camera that looks askew; the truth that is scored is the base's.
TEST(Replay, AKittiFolderIsScoredByItsPosesOfTheCamera) {
  const fs::path folder = kitti_folder("kitti_truth");
  const std::vector<StampedPose>& truth_world_base = recorded_drive().truth_world_base;
  const SE3 T_base_camera = SE3::from_rpy({0.2, -0.4, 0.7}, {0.5, -0.3, 0.4});
  const SE3 T_first_world = (truth_world_base.front().pose * T_base_camera).inverse();
  const auto row = [](const SE3& T) {
    const Eigen::Matrix4d m = T.matrix4();
    std::string text;
    for (int i = 0; i < 12; ++i) text += fmt::format("{} ", m(i / 4, i % 4));
    return text;
  };
  std::string poses;
  for (const StampedPose& truth : truth_world_base)
    poses += row(T_first_world * truth.pose * T_base_camera) + '\n';
  write_file(folder / "poses.txt", poses);
  const Outcome unscored = replay(folder);
  EXPECT_EQ(unscored.code, 0);
  EXPECT_THAT(unscored.err, HasSubstr("poses.txt is not used"));
  const std::string mount =
      row(T_base_camera.inverse() * recorded_drive().sheet.calibration.lidar.T_base_lidar);
  write_file(folder / "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: " + mount + '\n');
  ASSERT_EQ(replay(folder).code, 0);
  EXPECT_LT(json_of(result("kitti_truth") / "metrics.json")["ate_rmse_m"], 0.05);
  const PoseTrajectory scored = read_tum(result("kitti_truth") / "truth.tum");
  ASSERT_EQ(scored.size(), truth_world_base.size());
  const SE3 moved = scored.front().pose.inverse() * scored.back().pose;
  const SE3 expected = truth_world_base.front().pose.inverse() * truth_world_base.back().pose;
  EXPECT_LT((moved.inverse() * expected).log().norm(), 1e-6);

  write_file(folder / "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(replay(folder).err, HasSubstr("calib.txt: expected a line `Tr:`"));
}

TEST(Replay, ErrorsSayWhatToDo) {
  const fs::path folder = dataset("errors");
  const auto fails = [](const Outcome& outcome, const char* what) {
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(what));
  };
  fails(replay(scratch_folder() / "absent"), "absent: no such file");
  fails(replay(folder, {"--rig", "vlp16_onyl"}), "did you mean vlp16_only?");
  fails(replay(folder, {"--topic", "imu=/imu/dat"}), "did you mean /imu/data?");
  fails(replay(folder, {"--topic", "radar=/x"}), "expected SENSOR=TOPIC");
  fails(replay(folder, {"--set", "slam.priro=imu"}), "prior");
  fails(replay(folder, {"--method", "vs-slamm"}), "vs-slam");
  fs::remove(folder / "rig.yaml");
  fails(replay(folder), "--rig");
  write_bag(scratch_folder() / "empty.bag")->finish();
  fails(replay(scratch_folder() / "empty.bag", {"--rig", "vlp16_only"}), "no messages");
  fs::create_directories(scratch_folder() / "nothing");
  fails(replay(scratch_folder() / "nothing", {"--rig", "vlp16_only"}), "no recording");
}

TEST(Replay, PosesBetweenPosesAreInterpolated) {
  const std::vector<StampedPose> line = {{Time{0}, SE3()}, {Time{100}, {Quat::Identity(), Vec3(1, 0, 0)}}};
  EXPECT_NEAR(pose_at(line, Time{25}, 1)->translation.x(), 0.25, 1e-12);
  EXPECT_EQ(pose_at(line, Time{100}, 1)->translation.x(), 1);
  EXPECT_FALSE(pose_at(line, Time{101}, 1));
  EXPECT_FALSE(pose_at(line, Time{-1}, 1));
  EXPECT_FALSE(pose_at(line, Time{25}, 1e-8));
}

}  // namespace
}  // namespace vsslam

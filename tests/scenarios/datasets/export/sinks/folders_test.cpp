#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "core/files.h"
#include "scenarios/datasets/export/sinks/cloud_folder_sink.h"
#include "scenarios/datasets/export/sinks/euroc_sink.h"
#include "scenarios/datasets/export/sinks/kitti_sink.h"
#include "scenarios/datasets/export/sinks/truth_trajectory_sink.h"
#include "scenarios/datasets/export/sinks/tum_sink.h"
#include "scenarios/datasets/formats/cloud_files.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "tests/scenarios/datasets/dataset_samples.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string tail_of(const std::string& bytes, size_t count) {
  return bytes.substr(bytes.size() - count);
}

TEST(CloudFiles, HaveAHeaderAndPackedPoints) {
  LidarScan scan;
  scan.points = {{1, 2, 3, 51, 4, 0.5f}};
  const std::string pcd = pcd_of_scan(scan), ply = ply_of_scan(scan);
  EXPECT_THAT(pcd, HasSubstr("FIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\nTYPE F F F F U F\n"));
  EXPECT_THAT(pcd, HasSubstr("POINTS 1\nDATA binary\n"));
  EXPECT_THAT(ply, HasSubstr("element vertex 1\n"));
  EXPECT_THAT(ply, HasSubstr("property ushort ring\nproperty float time\nend_header\n"));
  EXPECT_EQ(tail_of(pcd, 22), tail_of(ply, 22));
  const std::string kitti = kitti_of_scan(scan);
  ASSERT_EQ(kitti.size(), 16u);
  float values[4];
  std::memcpy(values, kitti.data(), 16);
  EXPECT_EQ(values[2], 3.0f);
  EXPECT_FLOAT_EQ(values[3], 0.2f);
}

TEST(CloudFiles, LabelsAreThoseOfSemanticKitti) {
  PointTruth truth;
  truth.object = 3;
  truth.material = 258;
  EXPECT_EQ(labels_of(std::vector{truth}), std::string("\x02\x01\x03\x00", 4));
}

TEST(EurocFolder, IsTheAslLayout) {
  const fs::path folder = scratch_folder() / "euroc_sink";
  const DatasetFacts facts = askew_facts(folder);
  EurocSink sink(facts);
  EXPECT_TRUE(sink.needs_image(Time{0}));
  // The base turns about z at 1 rad/s: the IMU, off centre, moves.
  DatasetSample imu = imu_sample(0, {0.25, 0, 1}, {0, 0.5, 9.75});
  imu.base.T_world_base = SE3::from_rpy({0, 0, 0.5}, {10, 20, 0});
  imu.base.omega_base = {0, 0, 1};
  std::get<ImuMeasurement>(imu.measurement).gyro_bias_radps = {0.125, 0, 0};
  sink.write(imu);
  sink.write(image_sample(0, 0.005, "first"));
  sink.write(imu_sample(0.01));
  sink.write(image_sample(1, 0.015, "last"));  // no IMU sample after it
  EXPECT_FALSE(fs::exists(folder / "mav0/imu0/data.csv"));
  sink.finish();

  EXPECT_EQ(read_file(folder / "mav0/imu0/data.csv"),
            "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
            "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
            "1700000000000000000,0.25,0,1,0,0.5,9.75\n1700000000010000000,0,0,0,0,0,9.8\n");
  EXPECT_EQ(read_file(folder / "mav0/cam0/data.csv"),
            "#timestamp [ns],filename\n1700000000005000000,1700000000005000000.png\n");
  EXPECT_EQ(read_file(folder / "mav0/cam0/times.txt"), "1700000000005000000\n");
  EXPECT_EQ(read_file(folder / "mav0/cam0/data/1700000000005000000.png"), "first");
  EXPECT_FALSE(fs::exists(folder / "mav0/cam0/data/1700000000015000000.png"));
  EXPECT_FALSE(sink.needs_image(Time{5'000'000}));

  const std::string truth = read_file(folder / "mav0/state_groundtruth_estimate0/data.csv");
  const std::string row = truth.substr(truth.find('\n') + 1);
  std::vector<double> values;
  for (size_t at = row.find(','); at != std::string::npos && at < row.find('\n'); at = row.find(',', at + 1))
    values.push_back(std::stod(row.substr(at + 1)));
  ASSERT_EQ(values.size(), 16u);
  const SE3 T_world_imu = imu.base.T_world_base * facts.rig.imu.T_base_imu;
  const Vec3 arm_world = imu.base.T_world_base.rotation * facts.rig.imu.T_base_imu.translation;
  EXPECT_NEAR(values[0], T_world_imu.translation.x(), 1e-15);
  EXPECT_NEAR(values[3], T_world_imu.rotation.w(), 1e-15);
  EXPECT_NEAR(values[7], -arm_world.y(), 1e-12);
  EXPECT_NEAR(values[8], arm_world.x(), 1e-12);
  EXPECT_EQ(values[10], 0.125);
}

TEST(KittiFolder, PosesAreOfCamera0InItsFirstPlace) {
  const fs::path folder = scratch_folder() / "kitti_sink";
  const DatasetFacts facts = askew_facts(folder);
  KittiSink sink(facts);
  const SE3 T_world_a = SE3::from_rpy({0, 0, 0.3}, {5, 6, 0}),
            T_world_b = SE3::from_rpy({0, 0, 0.4}, {6, 6, 0});
  sink.write(image_sample(0, 0.97, "before"));
  sink.write(image_sample(1, 1.004, "at"));
  sink.write(image_sample(2, 1.037, "after"));
  sink.write(scan_sample(0, 1.0, T_world_a));
  sink.write(scan_sample(1, 1.1, T_world_b));
  sink.finish();
  EXPECT_EQ(read_file(folder / "times.txt"), "0\n0.1\n");
  EXPECT_EQ(read_file(folder / "image_0/000000.png"), "at");
  EXPECT_EQ(fs::file_size(folder / "velodyne/000001.bin"), 16u);
  const PoseTrajectory poses = read_kitti(folder / "poses.txt", folder / "times.txt");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_LT(poses[0].pose.log().norm(), 1e-12);
  const SE3& T_base_camera = facts.rig.camera.T_base_camera;
  const SE3 T_first_second = (T_world_a * T_base_camera).inverse() * T_world_b * T_base_camera;
  EXPECT_LT((poses[1].pose.inverse() * T_first_second).log().norm(), 1e-12);
  EXPECT_THAT(read_file(folder / "calib.txt"),
              HasSubstr("P3: 384.2 0 319.5 0 0 384.2 236.4 0 0 0 1 0\nTr: "));
}

TEST(KittiFolder, WithoutACameraItSitsInTheLidar) {
  const fs::path folder = scratch_folder() / "kitti_sink_blind";
  KittiSink sink(askew_facts(folder, false));
  sink.write(scan_sample(0, 0));
  sink.finish();
  EXPECT_FALSE(fs::exists(folder / "image_0"));
  const std::string calibration = read_file(folder / "calib.txt");
  std::istringstream numbers(calibration.substr(calibration.find("Tr: ") + 4));
  for (const double expected : {0, -1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0}) {
    double value = 99;
    numbers >> value;
    EXPECT_NEAR(value, expected, 1e-15);
  }
}

TEST(CloudFolder, NamesScansByNumberAndListsTheirTimes) {
  const fs::path folder = scratch_folder() / "cloud_sink";
  const DatasetFacts facts = askew_facts(folder);
  CloudFolderSink sink(facts, CloudFolderSink::Format::ply);
  EXPECT_TRUE(sink.needs_scan(0, Time{0}));
  sink.write(scan_sample(0, 2));
  sink.finish();
  EXPECT_FALSE(sink.needs_scan(0, Time{0}));
  EXPECT_EQ(read_file(folder / "ply/times.csv"),
            "file,stamp_ns,end_ns\n000000.ply,1700000002000000000,1700000002099000000\n");
}

TEST(TumFolder, ListsImagesAndTracksTheCamera) {
  const fs::path folder = scratch_folder() / "tum_sink";
  const DatasetFacts facts = askew_facts(folder);
  TumSink sink(facts);
  DatasetSample imu = imu_sample(0.01, {0, 0, 0}, {1, 2, 9.5});
  imu.base.T_world_base = SE3::from_rpy({0, 0, 1}, {3, 4, 5});
  sink.write(imu);
  sink.write(image_sample(0, 0.02, "png"));
  sink.finish();
  EXPECT_THAT(read_file(folder / "rgb.txt"),
              HasSubstr("\n1700000000.020000000 rgb/1700000000.020000000.png\n"));
  EXPECT_EQ(read_file(folder / "rgb/1700000000.020000000.png"), "png");
  EXPECT_THAT(read_file(folder / "accelerometer.txt"), HasSubstr("\n1700000000.010000000 1 2 9.5\n"));
  const PoseTrajectory poses = read_tum(folder / "groundtruth.txt");
  ASSERT_EQ(poses.size(), 1u);
  const SE3 T_world_camera = imu.base.T_world_base * facts.rig.camera.T_base_camera;
  EXPECT_LT((poses[0].pose.translation - T_world_camera.translation).norm(), 1e-8);
}

TEST(TruthTrajectory, IsOfTheBaseAtEveryScan) {
  const fs::path folder = scratch_folder() / "truth_sink";
  TruthTrajectorySink sink(askew_facts(folder));
  sink.write(scan_sample(0, 0.5, SE3::from_rpy({0, 0, 0}, {1, 2, 3})));
  sink.write(imu_sample(0.6));
  sink.finish();
  EXPECT_EQ(read_file(folder / "truth.tum"),
            "1700000000.500000000 1.000000000 2.000000000 3.000000000 0.000000000 0.000000000 0.000000000 "
            "1.000000000\n");
}

TEST(DatasetSinks, LeaveNothingUnfinished) {
  const fs::path folder = scratch_folder() / "unfinished";
  {
    EurocSink sink(askew_facts(folder));
    sink.write(imu_sample(0));
  }
  EXPECT_FALSE(fs::exists(folder / "mav0/imu0/data.csv"));
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    EXPECT_THAT(entry.path().string(), ::testing::Not(HasSubstr(".part")));
}

}  // namespace
}  // namespace vsslam

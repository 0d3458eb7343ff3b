// The configurations of other systems, read back by a parser that is not ours: every matrix against the rig.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "core/errors.h"
#include "scenarios/datasets/systems/target_system.h"
#include "tests/scenarios/datasets/dataset_samples.h"

namespace vsslam {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

std::string file_of(const char* system, const std::string& path, const DatasetFacts& facts) {
  for (const ExtraFile& file : target_system(system).configuration(facts))
    if (file.path == path) return file.content;
  ADD_FAILURE() << system << " has no " << path;
  return {};
}

// OpenCV's dialect has a header that YAML does not know, and tags.
YAML::Node parse(std::string text) {
  for (const std::string foreign : {"%YAML:1.0\n", "!!opencv-matrix"})
    for (size_t at = 0; (at = text.find(foreign, at)) != std::string::npos;) text.erase(at, foreign.size());
  return YAML::Load(text);
}

YAML::Node config(const char* system, const std::string& path, const DatasetFacts& facts) {
  return parse(file_of(system, path, facts));
}

void expect_rotation(const YAML::Node& numbers, const Mat3& expected) {
  ASSERT_EQ(numbers.size(), 9u);
  for (int i = 0; i < 9; ++i)
    EXPECT_NEAR(numbers[static_cast<size_t>(i)].as<double>(), expected(i / 3, i % 3), 1e-15) << i;
}

void expect_vector(const YAML::Node& numbers, const Vec3& expected) {
  ASSERT_EQ(numbers.size(), 3u);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(numbers[static_cast<size_t>(i)].as<double>(), expected[i], 1e-15) << i;
}

// Row-major 4 x 4, flat or as rows.
void expect_transform(const YAML::Node& numbers, const SE3& expected) {
  const Eigen::Matrix4d m = expected.matrix4();
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) {
      const auto row = static_cast<size_t>(r), column = static_cast<size_t>(c);
      const YAML::Node value = numbers.size() == 16 ? numbers[4 * row + column] : numbers[row][column];
      EXPECT_NEAR(value.as<double>(), m(r, c), 1e-15) << r << ' ' << c;
    }
}

class Systems : public ::testing::Test {
 protected:
  DatasetFacts facts(const char* system) {
    DatasetFacts facts = askew_facts("unused");
    facts.names = target_system(system).names;
    return facts;
  }
  const RigCalibration rig = askew_facts("unused").rig;
  const SE3 T_lidar_imu = rig.lidar.T_base_lidar.inverse() * rig.imu.T_base_imu;
  const SE3 T_imu_camera = rig.imu.T_base_imu.inverse() * rig.camera.T_base_camera;
};

// A vector that the IMU measures, turned by extrinsicRot, is the LiDAR's; an orientation of the IMU times the inverse of
// extrinsicRPY is the LiDAR's.
TEST_F(Systems, LioSamTurnsImuIntoLidar) {
  const YAML::Node p = config("lio-sam", "lio_sam/params.yaml", facts("lio-sam"))["lio_sam"];
  expect_rotation(p["extrinsicRot"], T_lidar_imu.matrix3());
  expect_rotation(p["extrinsicRPY"], T_lidar_imu.matrix3());
  EXPECT_EQ(p["mappingCornerLeafSize"].as<double>(), 0.1);
  EXPECT_EQ(p["mappingSurfLeafSize"].as<double>(), 0.2);
  expect_vector(p["extrinsicTrans"], T_lidar_imu.translation);
  EXPECT_EQ(p["pointCloudTopic"].as<std::string>(), "/points_raw");
  EXPECT_EQ(p["imuTopic"].as<std::string>(), "/imu_raw");
  EXPECT_EQ(p["sensor"].as<std::string>(), "velodyne");
  EXPECT_EQ(p["N_SCAN"].as<int>(), 16);
  EXPECT_EQ(p["imuAccNoise"].as<double>(), rig.imu.accel_noise_mps2_rthz);
  EXPECT_EQ(p["imuGyrBiasN"].as<double>(), rig.imu.gyro_bias_walk_radps2_rthz);
  EXPECT_EQ(p["lidarFrame"].as<std::string>(), target_system("lio-sam").names.lidar_frame);
}

TEST_F(Systems, LviSamKnowsLidarImuAndCamera) {
  const YAML::Node lidar = config("lvi-sam", "lvi_sam/params_lidar.yaml", facts("lvi-sam"))["lvi_sam"];
  expect_rotation(lidar["extrinsicRot"], T_lidar_imu.matrix3());
  expect_rotation(lidar["extrinsicRPY"], T_lidar_imu.matrix3().transpose());  // taken as it is
  EXPECT_EQ(lidar["timeField"].as<std::string>(), "time");
  const YAML::Node camera = config("lvi-sam", "lvi_sam/params_camera.yaml", facts("lvi-sam"));
  expect_rotation(camera["extrinsicRotation"]["data"], T_imu_camera.matrix3());
  expect_vector(camera["extrinsicTranslation"]["data"], T_imu_camera.translation);
  EXPECT_EQ(camera["image_topic"].as<std::string>(), "/camera/image_raw");
  EXPECT_EQ(camera["projection_parameters"]["fx"].as<double>(), rig.camera.fx_px);
  EXPECT_EQ(camera["distortion_parameters"]["p2"].as<double>(), 0.002);
  EXPECT_DOUBLE_EQ(camera["acc_n"].as<double>(), rig.imu.accel_noise_mps2_rthz * std::sqrt(rig.imu.rate_hz));

  // A point, once straight from the LiDAR to the camera, once by lidar_to_cam and then from the axes of a robot
  // (x forward, y left, z up) to those of a camera.
  const auto number = [&](const char* key) {
    return camera[std::string("lidar_to_cam_") + key].as<double>();
  };
  const SE3 T_forward_lidar =
      SE3::from_rpy({number("rx"), number("ry"), number("rz")}, {number("tx"), number("ty"), number("tz")});
  const Vec3 point_lidar(7, -2, 1);
  const Vec3 forward = T_forward_lidar * point_lidar;
  const Vec3 point_camera = rig.camera.T_base_camera.inverse() * rig.lidar.T_base_lidar * point_lidar;
  EXPECT_LT((Vec3(-forward.y(), -forward.z(), forward.x()) - point_camera).norm(), 1e-12);
}

TEST_F(Systems, FastLioHasTheLidarInTheImu) {
  const YAML::Node p = config("fast-lio", "fast_lio/velodyne.yaml", facts("fast-lio"));
  expect_rotation(p["mapping"]["extrinsic_R"], T_lidar_imu.inverse().matrix3());
  expect_vector(p["mapping"]["extrinsic_T"], T_lidar_imu.inverse().translation);
  EXPECT_EQ(p["preprocess"]["timestamp_unit"].as<int>(), 0);
  EXPECT_EQ(p["preprocess"]["lidar_type"].as<int>(), 2);
  EXPECT_EQ(p["preprocess"]["scan_line"].as<int>(), 16);
  EXPECT_DOUBLE_EQ(p["mapping"]["acc_cov"].as<double>(),
                   std::pow(rig.imu.accel_noise_mps2_rthz, 2) * rig.imu.rate_hz);
  EXPECT_EQ(p["common"]["lid_topic"].as<std::string>(), "/velodyne_points");
}

TEST_F(Systems, OpenVinsHasTheCameraInTheImu) {
  const YAML::Node camera =
      config("openvins", "openvins/kalibr_imucam_chain.yaml", facts("openvins"))["cam0"];
  expect_transform(camera["T_imu_cam"], T_imu_camera);
  EXPECT_EQ(camera["rostopic"].as<std::string>(), "/cam0/image_raw");
  EXPECT_EQ(camera["distortion_model"].as<std::string>(), "radtan");
  EXPECT_EQ(camera["intrinsics"][2].as<double>(), rig.camera.cx_px);
  const YAML::Node imu = config("openvins", "openvins/kalibr_imu_chain.yaml", facts("openvins"))["imu0"];
  EXPECT_EQ(imu["gyroscope_noise_density"].as<double>(), rig.imu.gyro_noise_radps_rthz);
  EXPECT_EQ(imu["rostopic"].as<std::string>(), "/imu0");
  const YAML::Node estimator = config("openvins", "openvins/estimator_config.yaml", facts("openvins"));
  EXPECT_EQ(estimator["relative_config_imucam"].as<std::string>(), "kalibr_imucam_chain.yaml");
  EXPECT_EQ(estimator["max_cameras"].as<int>(), 1);
}

TEST_F(Systems, VinsFusionHasTheCameraInTheBody) {
  const YAML::Node p = config("vins-fusion", "vins_fusion/mono_imu_config.yaml", facts("vins-fusion"));
  expect_transform(p["body_T_cam0"]["data"], T_imu_camera);
  EXPECT_EQ(p["cam0_calib"].as<std::string>(), "cam0_pinhole.yaml");
  EXPECT_DOUBLE_EQ(p["gyr_n"].as<double>(), rig.imu.gyro_noise_radps_rthz * std::sqrt(rig.imu.rate_hz));
  const YAML::Node camera = config("vins-fusion", "vins_fusion/cam0_pinhole.yaml", facts("vins-fusion"));
  EXPECT_EQ(camera["model_type"].as<std::string>(), "PINHOLE");
  EXPECT_EQ(camera["projection_parameters"]["cy"].as<double>(), rig.camera.cy_px);
}

TEST_F(Systems, OrbSlam3HasTheCameraInTheBodyAndRealNumbersWithPoints) {
  const DatasetFacts orb = facts("orb-slam3");
  const YAML::Node p = config("orb-slam3", "orb_slam3/settings.yaml", orb);
  expect_transform(p["IMU.T_b_c1"]["data"], T_imu_camera);
  EXPECT_EQ(p["IMU.NoiseGyro"].as<double>(), rig.imu.gyro_noise_radps_rthz);
  EXPECT_EQ(p["Camera1.fx"].as<double>(), rig.camera.fx_px);
  const std::string text = file_of("orb-slam3", "orb_slam3/settings.yaml", orb);
  EXPECT_THAT(text, HasSubstr("Camera1.k2: 0.0\n"));
  EXPECT_THAT(text, HasSubstr("IMU.Frequency: 100.0\n"));
  EXPECT_THAT(text, HasSubstr("Camera.fps: 30\n"));
  EXPECT_EQ(target_system("orb-slam3").format, DatasetFormat::euroc);
}

TEST_F(Systems, KissIcpAndEvalioNameTopicAndRanges) {
  const YAML::Node p = config("kiss-icp", "kiss_icp.yaml", facts("kiss-icp"));
  EXPECT_EQ(p["data"]["max_range"].as<double>(), rig.lidar.max_range_m);
  EXPECT_EQ(p["mapping"]["voxel_size"].as<double>(), 0.5);
  DatasetFacts outdoors = facts("kiss-icp");
  outdoors.scenario.slam.odometry.voxel_m = 0.4;
  EXPECT_EQ(config("kiss-icp", "kiss_icp.yaml", outdoors)["mapping"]["voxel_size"].as<double>(), 1.0);
  EXPECT_THAT(target_system("kiss-icp").instructions(facts("kiss-icp")),
              HasSubstr("/velodyne_points askew.bag"));
  const std::string python = file_of("evalio", "vsslam_dataset.py", facts("evalio"));
  EXPECT_THAT(python, HasSubstr("num_rows=16,"));
  EXPECT_THAT(python, HasSubstr("num_columns=1817,"));
  EXPECT_THAT(python, HasSubstr("HERE / \"askew.bag\""));
}

// YAML 1.1, which ROS' Python reads, has no numbers with an exponent but without a point.
TEST_F(Systems, SmallNumbersAreNumbersToPython) {
  DatasetFacts small = facts("lio-sam");
  small.rig.imu.gyro_noise_radps_rthz = 1e-5;
  small.rig.imu.accel_bias_walk_mps3_rthz = 2e-7;
  small.rig.lidar.T_base_lidar.translation.x() = 3e-16;
  for (const TargetSystem& system : target_systems())
    for (const ExtraFile& file : system.configuration(small)) {
      if (!file.path.ends_with(".yaml")) continue;
      EXPECT_THAT(file.content, Not(ContainsRegex("(^|[^0-9.])[0-9]+e[-+]?[0-9]"))) << file.path;
    }
  EXPECT_THAT(file_of("lio-sam", "lio_sam/params.yaml", small), HasSubstr("imuGyrNoise: 1.0e-05\n"));
}

TEST_F(Systems, AllAreCompleteAndHaveInstructions) {
  EXPECT_EQ(target_systems().size(), 8u);
  for (const TargetSystem& system : target_systems()) {
    EXPECT_FALSE(system.configuration(facts(system.name.c_str())).empty()) << system.name;
    EXPECT_FALSE(system.instructions(facts(system.name.c_str())).empty()) << system.name;
    EXPECT_EQ(system.names.image.empty(), false);
  }
}

TEST(SystemNames, MistakesGetTheNearestName) {
  const auto error = [](auto&& body) -> std::string {
    try {
      body();
    } catch (const InputError& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_THAT(error([] { target_system("lio-sma"); }),
              HasSubstr("unknown system \"lio-sma\" (did you mean lio-sam?)"));
  EXPECT_THAT(error([] { target_system("cartographer"); }), HasSubstr("one of: lio-sam, lvi-sam"));
  EXPECT_THAT(error([] { parse_format("eurok"); }), HasSubstr("did you mean euroc?"));
}

}  // namespace
}  // namespace vsslam

// LVI-SAM, OpenVINS, VINS-Fusion and ORB-SLAM3 read their configurations by OpenCV, which takes less than YAML.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>

#include "scenarios/datasets/systems/target_system.h"
#include "tests/scenarios/datasets/dataset_samples.h"

namespace vsslam {
namespace {

cv::FileStorage open(const char* system, const std::string& path) {
  DatasetFacts facts = askew_facts("unused");
  facts.names = target_system(system).names;
  for (const ExtraFile& file : target_system(system).configuration(facts))
    if (file.path == path) return {file.content, cv::FileStorage::READ | cv::FileStorage::MEMORY};
  return {};
}

const RigCalibration& rig() {
  static const RigCalibration calibration = askew_facts("unused").rig;
  return calibration;
}

Eigen::Matrix4d T_imu_camera() {
  return (rig().imu.T_base_imu.inverse() * rig().camera.T_base_camera).matrix4();
}

void expect_matrix(const cv::FileNode& node, const Eigen::MatrixXd& expected, double within) {
  cv::Mat m;
  node >> m;
  ASSERT_EQ(m.rows, expected.rows());
  ASSERT_EQ(m.cols, expected.cols());
  m.convertTo(m, CV_64F);
  for (int r = 0; r < m.rows; ++r)
    for (int c = 0; c < m.cols; ++c) EXPECT_NEAR(m.at<double>(r, c), expected(r, c), within) << r << ' ' << c;
}

TEST(OpenCvReads, LviSam) {
  const cv::FileStorage file = open("lvi-sam", "lvi_sam/params_camera.yaml");
  ASSERT_TRUE(file.isOpened());
  EXPECT_EQ(file["imu_topic"].string(), "/imu_raw");
  EXPECT_EQ(file["projection_parameters"]["fx"].real(), rig().camera.fx_px);
  EXPECT_EQ(file["distortion_parameters"]["k1"].real(), -0.01);
  expect_matrix(file["extrinsicRotation"], T_imu_camera().topLeftCorner(3, 3), 1e-15);
  expect_matrix(file["extrinsicTranslation"], T_imu_camera().topRightCorner(3, 1), 1e-15);
}

TEST(OpenCvReads, VinsFusion) {
  const cv::FileStorage file = open("vins-fusion", "vins_fusion/mono_imu_config.yaml");
  ASSERT_TRUE(file.isOpened());
  expect_matrix(file["body_T_cam0"], T_imu_camera(), 1e-15);
  EXPECT_EQ(static_cast<int>(file["image_width"]), 640);
  const cv::FileStorage camera = open("vins-fusion", "vins_fusion/cam0_pinhole.yaml");
  ASSERT_TRUE(camera.isOpened());
  EXPECT_EQ(camera["model_type"].string(), "PINHOLE");
  EXPECT_EQ(camera["projection_parameters"]["cx"].real(), rig().camera.cx_px);
}

TEST(OpenCvReads, OpenVins) {
  const cv::FileStorage file = open("openvins", "openvins/kalibr_imucam_chain.yaml");
  ASSERT_TRUE(file.isOpened());
  const cv::FileNode rows = file["cam0"]["T_imu_cam"];
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(static_cast<double>(rows[r][c]), T_imu_camera()(r, c), 1e-15);
  EXPECT_TRUE(open("openvins", "openvins/kalibr_imu_chain.yaml")["imu0"]["update_rate"].isInt() ||
              open("openvins", "openvins/kalibr_imu_chain.yaml")["imu0"]["update_rate"].isReal());
  EXPECT_EQ(open("openvins", "openvins/estimator_config.yaml")["gravity_mag"].real(), rig().imu.gravity_mps2);
}

// It ends the program at a real number that OpenCV takes for a whole one, and the other way round.
TEST(OpenCvReads, OrbSlam3) {
  const cv::FileStorage file = open("orb-slam3", "orb_slam3/settings.yaml");
  ASSERT_TRUE(file.isOpened());
  for (const char* real :
       {"Camera1.fx", "Camera1.fy", "Camera1.cx", "Camera1.cy", "Camera1.k1", "Camera1.k2", "Camera1.p1",
        "Camera1.p2", "IMU.NoiseGyro", "IMU.NoiseAcc", "IMU.GyroWalk", "IMU.AccWalk", "IMU.Frequency",
        "ORBextractor.scaleFactor", "Viewer.KeyFrameSize", "Viewer.ViewpointF"})
    EXPECT_TRUE(file[real].isReal()) << real;
  for (const char* whole :
       {"Camera.width", "Camera.height", "Camera.fps", "Camera.RGB", "ORBextractor.nFeatures",
        "ORBextractor.nLevels", "ORBextractor.iniThFAST", "ORBextractor.minThFAST"})
    EXPECT_TRUE(file[whole].isInt()) << whole;
  EXPECT_EQ(file["IMU.GyroWalk"].real(), rig().imu.gyro_bias_walk_radps2_rthz);
  expect_matrix(file["IMU.T_b_c1"], T_imu_camera(), 1e-6);
}

}  // namespace
}  // namespace vsslam

#include "scenarios/datasets/facts/rig_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/errors.h"

namespace vsslam {
namespace {

using ::testing::HasSubstr;

RigSheet from(const std::string& yaml) {
  RigSheet sheet;
  load_config_text(yaml, "rig.yaml", sheet);
  return sheet;
}

TEST(RigSheet, ComesBackToTheBit) {
  RigSheet sheet;
  sheet.topics = {"/a", "/b", "", "/d", "/e"};
  LidarCalibration& lidar = sheet.calibration.lidar;
  lidar.T_base_lidar = SE3::from_rpy({0.1, -0.2, 2.9}, {0.1, 1.0 / 3, -0.7});
  lidar.range_sigma_m = 0.1 + 0.2;
  sheet.calibration.imu.T_base_imu = SE3::from_rpy({1e-9, 3.0, 0.4}, {0, 1e-17, 0.12});
  sheet.calibration.camera.T_base_camera =
      SE3::from_rpy({-std::numbers::pi / 2, 0, -std::numbers::pi / 2}, {0.32, 0, 0.3});
  const RigSheet back = from(save_config(sheet));
  EXPECT_EQ(back.calibration.lidar.T_base_lidar.rotation.coeffs(), lidar.T_base_lidar.rotation.coeffs());
  EXPECT_EQ(back.calibration.lidar.T_base_lidar.translation, lidar.T_base_lidar.translation);
  EXPECT_EQ(back.calibration.imu.T_base_imu.rotation.coeffs(),
            sheet.calibration.imu.T_base_imu.rotation.coeffs());
  EXPECT_EQ(back.calibration.camera.T_base_camera.rotation.coeffs(),
            sheet.calibration.camera.T_base_camera.rotation.coeffs());
  EXPECT_EQ(back.calibration.lidar.range_sigma_m, lidar.range_sigma_m);
  EXPECT_EQ(save_config(back), save_config(sheet));
}

TEST(RigSheet, APersonWritesAngles) {
  const RigSheet sheet = from(
      "lidar: {T_base_lidar: {position_m: [1, 2, 3], rpy_deg: [0, 0, 90]}, rings: 32}\n"
      "camera: {T_base_camera: {quaternion: {w: 0.5, x: -0.5, y: 0.5, z: -0.5}}}\n");
  const Vec3 point_base = sheet.calibration.lidar.T_base_lidar * Vec3(1, 0, 0);
  EXPECT_LT((point_base - Vec3(1, 3, 3)).norm(), 1e-12);
  // The camera looks forward: its z is the base's x, its x the base's right.
  const SE3& T_base_camera = sheet.calibration.camera.T_base_camera;
  EXPECT_LT((T_base_camera * Vec3(0, 0, 1) - Vec3(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((T_base_camera * Vec3(1, 0, 0) - Vec3(0, -1, 0)).norm(), 1e-12);
}

TEST(RigSheet, WhatIsMissingKeepsItsDefault) {
  const RigSheet sheet = from("imu: {T_base_imu: {position_m: [0, 0, 1]}}\n");
  EXPECT_EQ(sheet.calibration.imu.T_base_imu.rotation.coeffs(), Quat::Identity().coeffs());
  EXPECT_EQ(sheet.calibration.lidar.rings, 16);
  EXPECT_EQ(sheet.topics.lidar, "");
}

TEST(RigSheet, MistakesAreErrorsWithAPlace) {
  const auto error = [](const std::string& yaml) -> std::string {
    try {
      from(yaml);
    } catch (const InputError& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_THAT(error("lidar:\n  ringz: 16\n"),
              HasSubstr("rig.yaml:2:3: unknown key \"ringz\" (did you mean rings?)"));
  EXPECT_THAT(error("lidar: {T_base_lidar: {quaternion: {w: 1}, rpy_deg: [0, 0, 0]}}"),
              HasSubstr("only one of quaternion and rpy_deg"));
  EXPECT_THAT(error("lidar: {T_base_lidar: {quaternion: {w: 0.9}}}"), HasSubstr("unit length"));
  EXPECT_THAT(error("lidar: {min_range_m: 5, max_range_m: 4}"), HasSubstr("more than min_range_m"));
}

}  // namespace
}  // namespace vsslam

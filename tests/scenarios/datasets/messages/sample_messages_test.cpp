#include "scenarios/datasets/messages/sample_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace vsslam {
namespace {

using ::testing::ElementsAre;

template <class T>
T read(const std::vector<uint8_t>& bytes, size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST(CloudMessage, IsTheLayoutOfRotatingLidars) {
  LidarScan scan;
  scan.stamp = Time{5};
  scan.points = {{1, 2, 3, 100, 15, 0}, {-4, 5.5f, 0.25f, 7, 3, 0.0995f}};
  const PointCloudMessage cloud = cloud_message(scan, "lidar");
  EXPECT_EQ(cloud.header.stamp, Time{5});
  EXPECT_EQ(cloud.header.frame_id, "lidar");
  EXPECT_EQ(cloud.height, 1u);
  EXPECT_EQ(cloud.width, 2u);
  EXPECT_EQ(cloud.point_step, 22u);
  EXPECT_EQ(cloud.row_step, 44u);
  EXPECT_TRUE(cloud.is_dense);
  EXPECT_FALSE(cloud.is_bigendian);
  std::string names;
  uint32_t offset = 0;
  for (const PointCloudMessage::Field& field : cloud.fields) {
    names += field.name + " ";
    EXPECT_EQ(field.offset, offset);
    EXPECT_EQ(field.count, 1u);
    offset += field.datatype == PointCloudMessage::Field::u16 ? 2 : 4;
  }
  EXPECT_EQ(names, "x y z intensity ring time ");
  EXPECT_EQ(offset, cloud.point_step);
  ASSERT_EQ(cloud.data.size(), 44u);
  EXPECT_EQ(read<float>(cloud.data, 22), -4.0f);
  EXPECT_EQ(read<float>(cloud.data, 22 + 4), 5.5f);
  EXPECT_EQ(read<float>(cloud.data, 22 + 8), 0.25f);
  EXPECT_EQ(read<float>(cloud.data, 22 + 12), 7.0f);
  EXPECT_EQ(read<uint16_t>(cloud.data, 22 + 16), 3);
  EXPECT_EQ(read<float>(cloud.data, 22 + 18), 0.0995f);
}

TEST(ImuMessage, SaysWhetherTheDeviceHasAnOrientation) {
  ImuSample sample;
  sample.gyro_radps = {1, 2, 3};
  sample.accel_mps2 = {4, 5, 6};
  const ImuDeviations deviations{
      .gyro_radps = 0.1, .accel_mps2 = 0.2, .roll_pitch_rad = 0.3, .heading_rad = 0.4};
  EXPECT_EQ(imu_message(sample, deviations, "imu").orientation_covariance[0], -1);
  sample.q_earth_imu = Quat(0, 1, 0, 0);
  const ImuMessage message = imu_message(sample, deviations, "imu");
  EXPECT_EQ(message.orientation.coeffs(), sample.q_earth_imu->coeffs());
  EXPECT_DOUBLE_EQ(message.orientation_covariance[0], 0.09);
  EXPECT_DOUBLE_EQ(message.orientation_covariance[8], 0.16);
  EXPECT_DOUBLE_EQ(message.angular_velocity_covariance[4], 0.01);
  EXPECT_DOUBLE_EQ(message.linear_acceleration_covariance[8], 0.04);
  EXPECT_EQ(message.angular_velocity, Vec3(1, 2, 3));
  EXPECT_EQ(message.linear_acceleration, Vec3(4, 5, 6));
}

TEST(CameraMessages, CarryPixelsAndIntrinsics) {
  CameraFrame frame{.stamp = Time{9}, .width_px = 3, .height_px = 2, .grey = {1, 2, 3, 4, 5, 6}};
  const ImageMessage image = image_message(frame, "camera");
  EXPECT_EQ(image.encoding, "mono8");
  EXPECT_EQ(image.step, 3u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_EQ(image.data, frame.grey);
  CameraCalibration camera;
  camera.k1 = 0.1;
  camera.p2 = 0.4;
  const CameraInfoMessage info = camera_info_message(camera, Time{9}, "camera");
  EXPECT_THAT(info.d, ElementsAre(0.1, 0, 0, 0.4, 0));
  EXPECT_THAT(info.k, ElementsAre(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1));
  EXPECT_THAT(info.p,
              ElementsAre(camera.fx_px, 0, camera.cx_px, 0, 0, camera.fy_px, camera.cy_px, 0, 0, 0, 1, 0));
  EXPECT_EQ(info.width, 640u);
}

TEST(StaticTransforms, LeadFromTheBaseToEverySensor) {
  RigCalibration rig;
  rig.lidar.T_base_lidar.translation = {1, 2, 3};
  const MessageNames names;
  EXPECT_EQ(static_transforms(rig, names, false, Time{1}).transforms.size(), 2u);
  const TransformsMessage message = static_transforms(rig, names, true, Time{1});
  ASSERT_EQ(message.transforms.size(), 3u);
  EXPECT_EQ(message.transforms[0].header.frame_id, "base");
  EXPECT_EQ(message.transforms[0].child_frame_id, "lidar");
  EXPECT_EQ(message.transforms[0].T_parent_child.translation, Vec3(1, 2, 3));
  EXPECT_EQ(message.transforms[2].child_frame_id, "camera");
}

// A quarter of a circle to the left: with track b and radius R the outer wheel runs (R + b/2) pi/2.
TEST(WheelOdometryOf, AQuarterCircleEndsWhereItShould) {
  const WheelCalibration wheels{.wheel_radius_m = 0.2, .effective_track_m = 0.8};
  WheelOdometry odometry(wheels);
  const MessageNames names;
  constexpr double kRadius_m = 2, kQuarter = std::numbers::pi / 2;
  constexpr int kSteps = 1000;
  OdometryMessage last;
  for (int i = 0; i <= kSteps; ++i) {
    const double turned_rad = kQuarter * i / kSteps;
    last = odometry.add({.stamp = Time::from_seconds(0.02 * i),
                         .left_rad = (kRadius_m - 0.4) * turned_rad / 0.2,
                         .right_rad = (kRadius_m + 0.4) * turned_rad / 0.2},
                        names);
  }
  EXPECT_NEAR(last.T_parent_child.translation.x(), kRadius_m, 1e-5);
  EXPECT_NEAR(last.T_parent_child.translation.y(), kRadius_m, 1e-5);
  EXPECT_NEAR(last.T_parent_child.rpy().z(), kQuarter, 1e-9);
  EXPECT_NEAR(last.linear_velocity_child.x(), kRadius_m * kQuarter / 20, 1e-9);
  EXPECT_NEAR(last.angular_velocity_child.z(), kQuarter / 20, 1e-9);
  EXPECT_EQ(last.header.frame_id, "odom");
  EXPECT_EQ(last.child_frame_id, "base");
}

TEST(WheelOdometryOf, StartsAtZeroWhateverTheEncodersSay) {
  WheelOdometry odometry(WheelCalibration{});
  const OdometryMessage first = odometry.add({.stamp = Time{0}, .left_rad = 100, .right_rad = 300}, {});
  EXPECT_EQ(first.T_parent_child.translation, Vec3(0, 0, 0));
  const OdometryMessage second = odometry.add({.stamp = Time{1000}, .left_rad = 101, .right_rad = 301}, {});
  EXPECT_NEAR(second.T_parent_child.translation.x(), WheelCalibration{}.wheel_radius_m, 1e-12);
}

}  // namespace
}  // namespace vsslam

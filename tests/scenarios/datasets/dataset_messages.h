// One message of every type, and what makes two of them equal.
#pragma once

#include <string>
#include <vector>

#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/datasets/messages/wire_format.h"

namespace vsslam {

inline constexpr int64_t kEpochNs = 1'700'000'000'000'000'000;

inline Time after_epoch(int64_t ns) {
  return {kEpochNs + ns};
}

/// Of `bytes` bytes, all different from their neighbours.
inline std::vector<uint8_t> some_bytes(size_t bytes, uint32_t seed) {
  std::vector<uint8_t> data(bytes);
  for (size_t i = 0; i < bytes; ++i) data[i] = static_cast<uint8_t>(((i + seed) * 2654435761u) >> 24);
  return data;
}

inline std::vector<MessageContent> one_of_each() {
  const MessageHeader header{7, after_epoch(123'456'789), "lidar"};
  const SE3 T_odom_base{Quat(0.5, 0.5, -0.5, 0.5), Vec3(1, -2, 0.25)};
  PointCloudMessage cloud{.header = header,
                          .width = 3,
                          .fields = {{"x", 0}, {"ring", 16, PointCloudMessage::Field::u16}, {"time", 18}},
                          .point_step = 22,
                          .row_step = 66,
                          .data = some_bytes(66, 1)};
  ImuMessage imu{.header = header, .orientation = Quat(0.1, 0.2, 0.3, 0.4), .orientation_covariance = {-1}};
  imu.angular_velocity = Vec3(0.01, -0.02, 0.03);
  imu.linear_acceleration = Vec3(0.1, 0.2, 9.81);
  const ImageMessage image{header, 2, 5, "mono8", 0, 5, some_bytes(10, 2)};
  const CompressedImageMessage compressed{header, "bgr8; jpeg compressed bgr8", some_bytes(13, 3)};
  CameraInfoMessage info{.header = header, .height = 480, .width = 640, .d = {0.1, -0.2, 0.001, 0.002, 0}};
  info.k = {600, 0, 320, 0, 601, 240, 0, 0, 1};
  info.p = {600, 0, 320, 0, 0, 601, 240, 0, 0, 0, 1, 0};
  OdometryMessage odometry{.header = header, .child_frame_id = "base", .T_parent_child = T_odom_base};
  odometry.pose_covariance[35] = 0.5;
  odometry.linear_velocity_child = Vec3(0.8, 0, 0);
  const JointStateMessage joints{header, {"left_wheel", "right_wheel"}, {1.5, -2.5}, {}, {3.5}};
  const PoseStampedMessage pose{header, T_odom_base};
  const TransformsMessage transforms{
      {{header, "imu", T_odom_base}, {{0, after_epoch(0), ""}, "camera", SE3()}}};
  return {cloud, imu, image, compressed, info, odometry, joints, pose, transforms};
}

/// Everything that a message holds.
inline std::string everything_in(const MessageContent& content) {
  std::string bytes;
  encode_message(content, WireFormat::ros1, bytes);
  return std::string(message_type(content)) + ' ' + bytes;
}

inline std::string everything_in(const Message& message) {
  return message.topic + ' ' + std::to_string(message.recorded.ns) + ' ' + everything_in(message.content);
}

inline std::vector<std::string> everything_in(MessageReader& reader) {
  std::vector<std::string> all;
  while (const auto message = reader.next()) all.push_back(everything_in(*message));
  return all;
}

}  // namespace vsslam

// What ROS calls the messages, and what MCAP files tell about them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// ROS 1's spelling.
template <class Message>
inline constexpr std::string_view kMessageType = "";
template <>
inline constexpr std::string_view kMessageType<PointCloudMessage> = "sensor_msgs/PointCloud2";
template <>
inline constexpr std::string_view kMessageType<ImuMessage> = "sensor_msgs/Imu";
template <>
inline constexpr std::string_view kMessageType<ImageMessage> = "sensor_msgs/Image";
template <>
inline constexpr std::string_view kMessageType<CompressedImageMessage> = "sensor_msgs/CompressedImage";
template <>
inline constexpr std::string_view kMessageType<CameraInfoMessage> = "sensor_msgs/CameraInfo";
template <>
inline constexpr std::string_view kMessageType<OdometryMessage> = "nav_msgs/Odometry";
template <>
inline constexpr std::string_view kMessageType<JointStateMessage> = "sensor_msgs/JointState";
template <>
inline constexpr std::string_view kMessageType<PoseStampedMessage> = "geometry_msgs/PoseStamped";
template <>
inline constexpr std::string_view kMessageType<TransformsMessage> = "tf2_msgs/TFMessage";

/// A default message of that type; nullopt: MessageContent has none. ROS 1's spelling.
std::optional<MessageContent> empty_message(std::string_view type);

/// sensor_msgs/Imu -> sensor_msgs/msg/Imu.
std::string ros2_type(std::string_view ros1_type);
/// sensor_msgs/msg/Imu -> sensor_msgs/Imu; others as they are. ROS 1's old tf/tfMessage becomes tf2_msgs/TFMessage.
std::string ros1_type(std::string_view type);

/// The definition of a message and of all that it holds, as MCAP's encoding `ros2msg` wants it.
/// https://mcap.dev/spec/registry#ros2msg
std::string ros2_definition(const MessageContent& content);

}  // namespace vsslam

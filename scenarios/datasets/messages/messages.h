// The robot messages of datasets and recordings, as plain structs: what sensor_msgs, nav_msgs and tf2_msgs define,
// without ROS. Names of members are ROS' own where they differ from ours only by taste.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/se3.h"
#include "core/time.h"

namespace vsslam {

struct MessageHeader {
  uint32_t seq = 0;  ///< ROS 1 only
  Time stamp;        ///< since 1970
  std::string frame_id;
};

/// Row-major covariance of three numbers; first element -1: the quantity is not measured.
using Covariance3 = std::array<double, 9>;
using Covariance6 = std::array<double, 36>;  ///< x y z, rotations about x y z

/// sensor_msgs/PointCloud2.
struct PointCloudMessage {
  struct Field {
    enum Type : uint8_t { i8 = 1, u8, i16, u16, i32, u32, f32, f64 };
    std::string name;
    uint32_t offset = 0;
    uint8_t datatype = f32;
    uint32_t count = 1;
  };
  MessageHeader header;
  uint32_t height = 1, width = 0;
  std::vector<Field> fields;
  bool is_bigendian = false;
  uint32_t point_step = 0, row_step = 0;  ///< bytes
  std::vector<uint8_t> data;
  bool is_dense = true;
};

/// sensor_msgs/Imu.
struct ImuMessage {
  MessageHeader header;
  Quat orientation = Quat::Identity();
  Covariance3 orientation_covariance{};
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
  Covariance3 angular_velocity_covariance{};
  Vec3 linear_acceleration = Vec3::Zero();  ///< m/s^2, +g upwards at rest
  Covariance3 linear_acceleration_covariance{};
};

/// sensor_msgs/Image.
struct ImageMessage {
  MessageHeader header;
  uint32_t height = 0, width = 0;
  std::string encoding;  ///< mono8, bgr8, 32FC1, ...
  uint8_t is_bigendian = 0;
  uint32_t step = 0;  ///< bytes of a row
  std::vector<uint8_t> data;
};

/// sensor_msgs/CompressedImage.
struct CompressedImageMessage {
  MessageHeader header;
  std::string format;  ///< "jpeg", "png", or as image_transport writes it: "bgr8; jpeg compressed bgr8"
  std::vector<uint8_t> data;
};

/// sensor_msgs/CameraInfo, without binning and region of interest (written as 0).
struct CameraInfoMessage {
  MessageHeader header;
  uint32_t height = 0, width = 0;
  std::string distortion_model = "plumb_bob";
  std::vector<double> d;      ///< k1 k2 p1 p2 k3
  std::array<double, 9> k{};  ///< row-major intrinsics
  std::array<double, 9> r{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 12> p{};  ///< row-major projection
};

/// nav_msgs/Odometry.
struct OdometryMessage {
  MessageHeader header;
  std::string child_frame_id;
  SE3 T_parent_child{Quat::Identity(), Vec3::Zero()};
  Covariance6 pose_covariance{};
  Vec3 linear_velocity_child = Vec3::Zero(), angular_velocity_child = Vec3::Zero();
  Covariance6 twist_covariance{};
};

/// sensor_msgs/JointState: accumulated wheel rotation.
struct JointStateMessage {
  MessageHeader header;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;
};

/// geometry_msgs/PoseStamped.
struct PoseStampedMessage {
  MessageHeader header;
  SE3 T_parent_child{Quat::Identity(), Vec3::Zero()};
};

/// tf2_msgs/TFMessage.
struct TransformsMessage {
  struct Transform {
    MessageHeader header;
    std::string child_frame_id;
    SE3 T_parent_child{Quat::Identity(), Vec3::Zero()};
  };
  std::vector<Transform> transforms;
};

using MessageContent =
    std::variant<PointCloudMessage, ImuMessage, ImageMessage, CompressedImageMessage, CameraInfoMessage,
                 OdometryMessage, JointStateMessage, PoseStampedMessage, TransformsMessage>;

/// One message of a bag or an MCAP file.
struct Message {
  std::string topic;
  Time recorded;  ///< since 1970; in a dataset of ours, the end of the acquisition
  MessageContent content;
};

/// "sensor_msgs/PointCloud2" and so on, ROS 1's spelling.
std::string_view message_type(const MessageContent& content);

}  // namespace vsslam

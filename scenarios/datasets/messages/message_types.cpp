#include "scenarios/datasets/messages/message_types.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace vsslam {

namespace {

template <size_t... I>
std::optional<MessageContent> empty_message(std::string_view type, std::index_sequence<I...>) {
  std::optional<MessageContent> found;
  ((type == kMessageType<std::variant_alternative_t<I, MessageContent>>
        ? (found.emplace(std::in_place_index<I>), true)
        : false) ||
   ...);
  return found;
}

struct Definition {
  const char* members;
  std::vector<std::string_view> holds{};
};

// Types, order and names of members as ROS 2 has them; its comments and constants left out.
const std::map<std::string_view, Definition>& definitions() {
  static const std::map<std::string_view, Definition> all{
      {"builtin_interfaces/Time", {"int32 sec\nuint32 nanosec\n"}},
      {"std_msgs/Header", {"builtin_interfaces/Time stamp\nstring frame_id\n", {"builtin_interfaces/Time"}}},
      {"geometry_msgs/Vector3", {"float64 x\nfloat64 y\nfloat64 z\n"}},
      {"geometry_msgs/Point", {"float64 x\nfloat64 y\nfloat64 z\n"}},
      {"geometry_msgs/Quaternion", {"float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"}},
      {"geometry_msgs/Pose",
       {"Point position\nQuaternion orientation\n", {"geometry_msgs/Point", "geometry_msgs/Quaternion"}}},
      {"geometry_msgs/Transform",
       {"Vector3 translation\nQuaternion rotation\n", {"geometry_msgs/Vector3", "geometry_msgs/Quaternion"}}},
      {"geometry_msgs/Twist", {"Vector3 linear\nVector3 angular\n", {"geometry_msgs/Vector3"}}},
      {"geometry_msgs/PoseWithCovariance", {"Pose pose\nfloat64[36] covariance\n", {"geometry_msgs/Pose"}}},
      {"geometry_msgs/TwistWithCovariance",
       {"Twist twist\nfloat64[36] covariance\n", {"geometry_msgs/Twist"}}},
      {"geometry_msgs/PoseStamped",
       {"std_msgs/Header header\nPose pose\n", {"std_msgs/Header", "geometry_msgs/Pose"}}},
      {"geometry_msgs/TransformStamped",
       {"std_msgs/Header header\nstring child_frame_id\nTransform transform\n",
        {"std_msgs/Header", "geometry_msgs/Transform"}}},
      {"sensor_msgs/PointField",
       {"uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
        "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"}},
      {"sensor_msgs/RegionOfInterest",
       {"uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"}},
      {"sensor_msgs/PointCloud2",
       {"std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
        "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
        {"std_msgs/Header", "sensor_msgs/PointField"}}},
      {"sensor_msgs/Imu",
       {"std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
        "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
        "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
        {"std_msgs/Header", "geometry_msgs/Quaternion", "geometry_msgs/Vector3"}}},
      {"sensor_msgs/Image",
       {"std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 "
        "step\n"
        "uint8[] data\n",
        {"std_msgs/Header"}}},
      {"sensor_msgs/CompressedImage",
       {"std_msgs/Header header\nstring format\nuint8[] data\n", {"std_msgs/Header"}}},
      {"sensor_msgs/CameraInfo",
       {"std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
        "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nRegionOfInterest "
        "roi\n",
        {"std_msgs/Header", "sensor_msgs/RegionOfInterest"}}},
      {"sensor_msgs/JointState",
       {"std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
        {"std_msgs/Header"}}},
      {"nav_msgs/Odometry",
       {"std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
        "geometry_msgs/TwistWithCovariance twist\n",
        {"std_msgs/Header", "geometry_msgs/PoseWithCovariance", "geometry_msgs/TwistWithCovariance"}}},
      {"tf2_msgs/TFMessage",
       {"geometry_msgs/TransformStamped[] transforms\n", {"geometry_msgs/TransformStamped"}}},
  };
  return all;
}

/// Adds what `type` holds, and what that holds, each once, in order of appearance.
void collect(std::string_view type, std::vector<std::string_view>& held) {
  for (const std::string_view member : definitions().at(type).holds)
    if (std::find(held.begin(), held.end(), member) == held.end()) {
      held.push_back(member);
      collect(member, held);
    }
}

}  // namespace

std::string_view message_type(const MessageContent& content) {
  return std::visit([]<class M>(const M&) { return kMessageType<M>; }, content);
}

std::optional<MessageContent> empty_message(std::string_view type) {
  return empty_message(type, std::make_index_sequence<std::variant_size_v<MessageContent>>());
}

std::string ros2_type(std::string_view ros1_type) {
  const size_t slash = ros1_type.find('/');
  return fmt::format("{}/msg{}", ros1_type.substr(0, slash), ros1_type.substr(slash));
}

std::string ros1_type(std::string_view type) {
  if (type == "tf/tfMessage") return std::string(kMessageType<TransformsMessage>);
  std::string name(type);
  if (const size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  return name;
}

std::string ros2_definition(const MessageContent& content) {
  const std::string_view type = message_type(content);
  std::string text = definitions().at(type).members;
  std::vector<std::string_view> held;
  collect(type, held);
  for (const std::string_view member : held)
    text += fmt::format("{:=<80}\nMSG: {}\n{}", "", member, definitions().at(member).members);
  return text;
}

}  // namespace vsslam

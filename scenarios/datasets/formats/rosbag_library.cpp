// C++17: see rosbag_library.h.
#include "scenarios/datasets/formats/rosbag_library.h"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <filesystem>

#include "core/errors.h"

namespace vsslam {

namespace {

/// What ROS' generated headers say about a type.
struct TypeTraits {
  const char *md5sum, *datatype, *definition;
};

template <class Message>
TypeTraits traits_of() {
  namespace traits = ros::message_traits;
  return {traits::md5sum<Message>(), traits::datatype<Message>(), traits::definition<Message>()};
}

const TypeTraits& traits_of(const std::string& type) {
  static const std::vector<TypeTraits> all{
      traits_of<sensor_msgs::PointCloud2>(), traits_of<sensor_msgs::Imu>(),
      traits_of<sensor_msgs::Image>(),       traits_of<sensor_msgs::CompressedImage>(),
      traits_of<sensor_msgs::CameraInfo>(),  traits_of<nav_msgs::Odometry>(),
      traits_of<sensor_msgs::JointState>(),  traits_of<geometry_msgs::PoseStamped>(),
      traits_of<tf2_msgs::TFMessage>(),
  };
  for (const TypeTraits& traits : all)
    if (type == traits.datatype) return traits;
  throw InputError(std::string("messages of this type are not known to the bag writer: ").append(type));
}

/// A message that is its bytes already.
struct SerializedMessage {
  const TypeTraits& traits;
  const std::string& bytes;
};

}  // namespace

}  // namespace vsslam

namespace ros {

namespace message_traits {
template <>
struct MD5Sum<vsslam::SerializedMessage> {
  static const char* value(const vsslam::SerializedMessage& m) { return m.traits.md5sum; }
};
template <>
struct DataType<vsslam::SerializedMessage> {
  static const char* value(const vsslam::SerializedMessage& m) { return m.traits.datatype; }
};
template <>
struct Definition<vsslam::SerializedMessage> {
  static const char* value(const vsslam::SerializedMessage& m) { return m.traits.definition; }
};
}  // namespace message_traits

namespace serialization {
template <>
struct Serializer<vsslam::SerializedMessage> {
  template <class Stream>
  static void write(Stream& stream, const vsslam::SerializedMessage& m) {
    std::memcpy(stream.advance(static_cast<uint32_t>(m.bytes.size())), m.bytes.data(), m.bytes.size());
  }
  static uint32_t serializedLength(const vsslam::SerializedMessage& m) {
    return static_cast<uint32_t>(m.bytes.size());
  }
};
}  // namespace serialization

}  // namespace ros

namespace vsslam {

struct RosbagOutput::State {
  std::string path;
  rosbag::Bag bag;
  std::map<std::string, boost::shared_ptr<ros::M_string>> connections;  // by topic

  template <class Action>
  void guarded(Action&& action) {
    try {
      action();
    } catch (const rosbag::BagException& error) {
      throw ResourceError(std::string(path).append(": write failed: ").append(error.what()));
    }
  }
};

RosbagOutput::RosbagOutput(const std::string& path) : state_(std::make_unique<State>()) {
  state_->path = path;
  try {
    state_->guarded([&] {
      state_->bag.open(path, rosbag::bagmode::Write);
      state_->bag.setCompression(rosbag::compression::LZ4);
    });
  } catch (const ResourceError&) {
    give_up();
    throw;
  }
}

RosbagOutput::~RosbagOutput() {
  give_up();
}

/// A bag's destructor closes it, which writes; if that throws, as on a full disk, the program ends. Such a bag is kept
/// instead, out of reach of destructors.
void RosbagOutput::give_up() {
  static auto& unclosable = *new std::vector<std::unique_ptr<State>>;
  try {
    state_->bag.close();
  } catch (...) {
    unclosable.push_back(std::move(state_));
  }
}

void RosbagOutput::write(const std::string& topic, const std::string& type, int64_t recorded_ns,
                         const std::string& bytes, bool latched) {
  const TypeTraits& traits = traits_of(type);
  boost::shared_ptr<ros::M_string>& connection = state_->connections[topic];
  if (!connection) {
    connection = boost::make_shared<ros::M_string>();
    *connection = {{"topic", topic},
                   {"type", traits.datatype},
                   {"md5sum", traits.md5sum},
                   {"message_definition", traits.definition}};
    if (latched) (*connection)["latching"] = "1";
  }
  ros::Time recorded;
  recorded.fromNSec(static_cast<uint64_t>(recorded_ns));
  state_->guarded([&] { state_->bag.write(topic, recorded, SerializedMessage{traits, bytes}, connection); });
}

void RosbagOutput::close() {
  state_->guarded([&] { state_->bag.close(); });
}

}  // namespace vsslam

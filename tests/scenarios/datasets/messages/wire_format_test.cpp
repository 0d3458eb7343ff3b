#include "scenarios/datasets/messages/wire_format.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "scenarios/datasets/messages/message_types.h"
#include "tests/scenarios/datasets/dataset_messages.h"

namespace vsslam {
namespace {

std::string encoded(const MessageContent& content, WireFormat format) {
  std::string bytes;
  encode_message(content, format, bytes);
  return bytes;
}

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (size_t i = 0; i + 1 < hex.size(); ++i)
    if (hex[i] != ' ') bytes += static_cast<char>(std::stoi(std::string(hex.substr(i++, 2)), nullptr, 16));
  return bytes;
}

class WireFormats : public testing::TestWithParam<WireFormat> {};
INSTANTIATE_TEST_SUITE_P(Datasets, WireFormats, testing::Values(WireFormat::ros1, WireFormat::cdr),
                         [](const auto& info) { return info.param == WireFormat::ros1 ? "ros1" : "cdr"; });

TEST_P(WireFormats, EveryTypeComesBack) {
  for (const MessageContent& content : one_of_each()) {
    const std::string type(message_type(content));
    MessageContent back = decode_message(type, encoded(content, GetParam()), GetParam());
    EXPECT_EQ(message_type(back), type);
    // ROS 2 has no seq.
    std::visit(
        [&](auto& message) {
          if constexpr (requires { message.header; })
            EXPECT_EQ(std::exchange(message.header.seq, 7), GetParam() == WireFormat::ros1 ? 7 : 0);
          else
            message.transforms.at(0).header.seq = 7;
        },
        back);
    EXPECT_EQ(everything_in(back), everything_in(content)) << type;
    const MessageContent empty = *empty_message(type);
    EXPECT_EQ(everything_in(decode_message(type, encoded(empty, GetParam()), GetParam())),
              everything_in(empty));
  }
}

TEST_P(WireFormats, EveryTruncationIsAnError) {
  for (const MessageContent& content : one_of_each()) {
    const std::string bytes = encoded(content, GetParam());
    for (size_t size = 0; size < bytes.size(); ++size)
      EXPECT_THROW(decode_message(message_type(content), bytes.substr(0, size), GetParam()), InputError)
          << size;
    EXPECT_THROW(decode_message(message_type(content), bytes + "four", GetParam()), InputError);
  }
}

TEST_P(WireFormats, FlippedBytesAreReadOrRefused) {
  for (const MessageContent& content : one_of_each()) {
    const std::string bytes = encoded(content, GetParam());
    for (size_t i = 0; i < bytes.size(); ++i)
      for (const char flip : {'\x01', '\x80', '\xff'}) {
        std::string broken = bytes;
        broken[i] = static_cast<char>(broken[i] ^ flip);
        try {
          decode_message(message_type(content), broken, GetParam());
        } catch (const InputError&) {
        }
      }
  }
}

TEST_P(WireFormats, StampsBeyondTheFormatAreErrors) {
  EXPECT_THROW(encoded(ImuMessage{.header = {0, Time{-1}, ""}}, GetParam()), InputError);
  EXPECT_THROW(encoded(ImuMessage{.header = {0, Time::from_seconds(4294967296.0), ""}}, GetParam()),
               InputError);
}

// Written by hand from the formats' descriptions.
TEST(WireFormat, Ros1HasNoGaps) {
  const PoseStampedMessage pose{{1, {2'000'000'003}, "map"}, {Quat(1, 0, 0, 0), Vec3(1, 2, -2)}};
  EXPECT_EQ(encoded(pose, WireFormat::ros1),
            from_hex("01000000 02000000 03000000 03000000 6d6170"
                     "000000000000f03f 0000000000000040 00000000000000c0"
                     "0000000000000000 0000000000000000 0000000000000000 000000000000f03f"));
}

TEST(WireFormat, CdrAlignsNumbersToTheirSize) {
  // velocity has no members, so nothing is aligned between its length and the next.
  const JointStateMessage joints{{1, {2'000'000'003}, "base"}, {"l"}, {1}, {}, {2}};
  EXPECT_EQ(encoded(joints, WireFormat::cdr),
            from_hex("00010000 02000000 03000000 05000000 6261736500 000000 01000000 02000000 6c00 0000"
                     "01000000 00000000 000000000000f03f 00000000 01000000 0000000000000040"));
}

TEST(WireFormat, OtherKindsOfCdrAreRefusedByName) {
  std::string bytes = encoded(ImuMessage{}, WireFormat::cdr);
  const auto refusal = [&](char kind) -> std::string {
    bytes[1] = kind;
    try {
      decode_message("sensor_msgs/Imu", bytes, WireFormat::cdr);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(0), "big-endian CDR, which is not read here");
  EXPECT_EQ(refusal(7), "CDR of kind 00 07, where plain little-endian CDR is 00 01");
  EXPECT_EQ(refusal(1), "");
}

TEST(WireFormat, CdrMayBePaddedAtItsEnd) {
  const std::string bytes = encoded(ImuMessage{}, WireFormat::cdr);
  EXPECT_NO_THROW(decode_message("sensor_msgs/Imu", bytes + std::string(3, '\0'), WireFormat::cdr));
}

TEST(WireFormat, RotationsOfTransformsAreUnitQuaternions) {
  PoseStampedMessage pose;
  const auto decoded = [&] {
    return std::get<PoseStampedMessage>(
        decode_message("geometry_msgs/PoseStamped", encoded(pose, WireFormat::ros1), WireFormat::ros1));
  };
  pose.T_parent_child.rotation = Quat(0, 0, 3, 4);
  EXPECT_EQ(decoded().T_parent_child.rotation.coeffs(), Eigen::Vector4d(0, 0.6, 0.8, 0));
  pose.T_parent_child.rotation.coeffs().setZero();
  EXPECT_EQ(decoded().T_parent_child.rotation.coeffs(), Quat::Identity().coeffs());
}

TEST(MessageTypes, AreSpelledBothWays) {
  EXPECT_EQ(ros2_type("sensor_msgs/Imu"), "sensor_msgs/msg/Imu");
  EXPECT_EQ(ros1_type("sensor_msgs/msg/Imu"), "sensor_msgs/Imu");
  EXPECT_EQ(ros1_type("sensor_msgs/Imu"), "sensor_msgs/Imu");
  EXPECT_EQ(ros1_type("tf/tfMessage"), "tf2_msgs/TFMessage");
  EXPECT_FALSE(empty_message("std_msgs/String"));
  EXPECT_FALSE(empty_message(""));
}

TEST(MessageTypes, DefinitionsHoldWhatTheyNameOnce) {
  for (const MessageContent& content : one_of_each()) {
    const std::string text = ros2_definition(content);
    const size_t header = text.find("MSG: std_msgs/Header\n");
    EXPECT_NE(header, std::string::npos) << text;
    EXPECT_EQ(text.find("MSG: std_msgs/Header\n", header + 1), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace vsslam

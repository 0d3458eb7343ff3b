#include "scenarios/datasets/import/message_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "scenarios/datasets/import/decoders/wheel_decoder.h"
#include "scenarios/datasets/messages/sample_messages.h"

namespace vsslam {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::ThrowsMessage;

constexpr Time kStart{1'700'000'000'000'000'000};

Time at(double s) {
  return kStart + Duration::from_seconds(s);
}

class GivenMessages : public MessageReader {
 public:
  explicit GivenMessages(std::vector<Message> messages) : messages_(std::move(messages)) {}
  const std::vector<RecordedTopic>& topics() const override { return topics_; }
  Time begin() const override { return messages_.front().recorded; }
  Time end() const override { return messages_.back().recorded; }
  std::optional<Message> next() override {
    return next_ == messages_.size() ? std::nullopt : std::optional(messages_[next_++]);
  }
  const std::string& damage() const override { return damage_; }

 private:
  std::vector<Message> messages_;
  std::vector<RecordedTopic> topics_;
  std::string damage_;
  size_t next_ = 0;
};

const TopicChoice kTopics = {
    {"lidar", "/points"}, {"imu", "/imu"}, {"camera", "/image"}, {"wheels", "/wheels"}, {"truth", "/truth"}};

MessageRecording recording(std::vector<Message> messages, const RigCalibration& rig = {},
                           const MessageSurvey& survey = {}) {
  return {std::make_unique<GivenMessages>(std::move(messages)), "a.bag", kTopics, rig, {}, {}, {}, survey};
}

ImuMessage imu(double s, double accel_mps2 = 9.81) {
  ImuMessage message = imu_message({at(s), Vec3::Zero(), Vec3::Zero(), std::nullopt}, {}, "imu");
  message.linear_acceleration = Vec3(0, 0, accel_mps2);
  return message;
}

LidarScan scan(double s) {
  return {at(s), {}, {{5, 0, 0, 1, 0, 0.0f}, {5, 1, 0, 1, 1, 0.0625f}}};
}

TEST(MessageRecording, AScanEndsWhereItWasRecordedIfThatIsNear) {
  const auto end_of = [](double recorded_s) {
    auto messages = recording({{"/points", at(recorded_s), cloud_message(scan(10), "lidar")}});
    const auto sample = messages.next();
    EXPECT_EQ(std::get<LidarScan>(sample->sample).end, sample->end);
    return sample->end;
  };
  EXPECT_EQ(end_of(10.063), at(10.063));
  EXPECT_EQ(end_of(10.2), at(10.0625));   // a long way from the sensor to the disk
  EXPECT_EQ(end_of(10.01), at(10.0625));  // recorded before it ended: another clock
}

TEST(MessageRecording, OrientationCountsWhereTheDeviceHasOne) {
  ImuMessage message = imu(1);
  EXPECT_FALSE(imu_of_message(message).q_earth_imu);
  message.orientation_covariance = {};
  EXPECT_FALSE(imu_of_message(message).q_earth_imu);  // as a driver leaves it that never sets it
  message.orientation = Quat(0, 0, 0, 0);
  EXPECT_FALSE(imu_of_message(message).q_earth_imu);
  message.orientation = Quat(0, 0, 0, 1);
  ASSERT_TRUE(imu_of_message(message).q_earth_imu);
  EXPECT_EQ(imu_of_message(message).q_earth_imu->z(), 1);
  message.orientation_covariance[0] = -1;
  EXPECT_FALSE(imu_of_message(message).q_earth_imu);
}

TEST(MessageRecording, StampsAreMovedToTheClockOfTheOthers) {
  MessageSurvey survey;
  survey.clocks.shifts["lidar"] = {{0, {}}, {1, Duration{5'000'000'000}}};
  MessageRecording read = recording({{"/points", at(10.0625), cloud_message(scan(10), "lidar")},
                                     {"/points", at(10.163), cloud_message(scan(5.1), "lidar")}},
                                    {}, survey);
  const auto first = read.next(), second = read.next();
  EXPECT_FALSE(first->moved);
  EXPECT_EQ(stamp_of(first->sample), at(10));
  EXPECT_TRUE(second->moved);
  EXPECT_EQ(stamp_of(second->sample), at(10.1));
  EXPECT_EQ(second->end, at(10.163));
  EXPECT_EQ(std::get<LidarScan>(second->sample).end, second->end);
}

TEST(MessageRecording, ABrokenPictureAmongGoodOnesIsLeftOut) {
  ImageMessage good;
  good.encoding = "mono8";
  good.width = good.height = good.step = 2;
  good.data.resize(4);
  ImageMessage broken = good;
  broken.data.pop_back();
  RigCalibration rig;
  rig.camera.width_px = rig.camera.height_px = 2;
  MessageRecording read =
      recording({{"/image", at(1), good}, {"/image", at(2), broken}, {"/image", at(3), good}}, rig);
  EXPECT_TRUE(read.next());
  EXPECT_TRUE(read.next());
  EXPECT_FALSE(read.next());
  EXPECT_EQ(read.unreadable(3), 1);
  EXPECT_THAT(read.notes(), Contains(HasSubstr("left out: a.bag: /image message 1")));
}

TEST(MessageRecording, WheelsComeFromJointsToTheBit) {
  JointStateMessage joints = joint_message({at(1), 0.1, 0.7}, "base");
  EXPECT_EQ(wheels_of_joints(joints)->left_rad, 0.1);
  EXPECT_EQ(wheels_of_joints(joints)->right_rad, 0.7);
  joints.name = {"front_LEFT", "rear_left", "front_right", "rear_right", "mast"};
  joints.position = {1, 3, 5, 7, 100};
  EXPECT_EQ(wheels_of_joints(joints)->left_rad, 2);
  EXPECT_EQ(wheels_of_joints(joints)->right_rad, 6);
  joints.position.resize(2);
  EXPECT_FALSE(wheels_of_joints(joints));
}

TEST(MessageRecording, WheelsComeFromTheTwistsOfOdometry) {
  const WheelCalibration wheels;
  WheelOdometry odometry(wheels);
  TwistIntegrator integrator(wheels);
  WheelSample turned;
  for (int i = 0; i <= 100; ++i) {
    const WheelSample sample{at(0.02 * i), 5 + 0.01 * i, -0.02 * i * i};
    turned = integrator.add(odometry.add(sample, {}));
  }
  EXPECT_NEAR(turned.left_rad, 1.0, 1e-9);
  EXPECT_NEAR(turned.right_rad, -200.0, 1e-7);
}

TEST(MessageRecording, GathersTheTruth) {
  OdometryMessage truth;
  truth.header.stamp = at(3);
  truth.T_parent_child.translation = Vec3(1, 2, 3);
  MessageRecording read = recording({{"/truth", at(3), truth}, {"/imu", at(3), imu(3)}});
  EXPECT_TRUE(std::holds_alternative<ImuSample>(read.next()->sample));
  ASSERT_EQ(read.truth_world_base().size(), 1u);
  EXPECT_EQ(read.truth_world_base()[0].pose.translation.z(), 3);
}

TEST(MessageRecording, EmptyStampsAreThoseOfTheRecording) {
  ImuMessage message = imu(3);
  message.header.stamp = Time{0};
  MessageRecording read = recording({{"/imu", at(4), message}});
  EXPECT_EQ(stamp_of(read.next()->sample), at(4));
  EXPECT_THAT(read.notes(), Contains(HasSubstr("/imu: empty stamps")));
}

TEST(MessageRecording, ErrorsNameTheTopicAndTheMessage) {
  ImageMessage image;
  image.encoding = "mono8";
  image.width = image.height = image.step = 2;
  image.data.resize(4);
  RigCalibration rig;
  rig.camera.width_px = rig.camera.height_px = 2;
  MessageRecording good = recording({{"/image", at(1), image}}, rig);
  EXPECT_TRUE(good.next());
  MessageRecording other =
      recording({{"/imu", at(1), imu(1)}, {"/image", at(1), image}, {"/image", at(2), image}});
  other.next();
  EXPECT_THAT([&] { other.next(); }, ThrowsMessage<InputError>(HasSubstr("a.bag: /image message 0")));
  EXPECT_THAT([&] { other.next(); },
              ThrowsMessage<InputError>(HasSubstr("/image message 1: an image of 2 x 2")));
}

}  // namespace
}  // namespace vsslam

#include "scenarios/datasets/import/topic_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"

namespace vsslam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::ThrowsMessage;

const std::vector<RecordedTopic> kRecorded = {
    {"/camera/depth/image_raw", "sensor_msgs/Image", 9},
    {"/camera/image_raw", "sensor_msgs/Image", 9},
    {"/camera/image_raw/compressed", "sensor_msgs/CompressedImage", 9},
    {"/imu/data", "sensor_msgs/Imu", 9},
    {"/imu/other", "sensor_msgs/Imu", 0},
    {"/joint_states", "sensor_msgs/JointState", 9},
    {"/odom", "nav_msgs/Odometry", 9},
    {"/points", "sensor_msgs/PointCloud2", 9},
    {"/text", "std_msgs/String", 9}};

TopicChoice chosen(const RecordingTopics& sheet = {},
                   const std::map<std::string, std::string>& overrides = {},
                   const std::vector<RecordedTopic>& topics = kRecorded) {
  std::vector<std::string> notes;
  return choose_topics(topics, sheet, overrides, "a.bag", notes);
}

TEST(TopicChoice, GuessesByType) {
  EXPECT_THAT(chosen(), ElementsAre(Pair("camera", "/camera/image_raw"), Pair("imu", "/imu/data"),
                                    Pair("lidar", "/points"), Pair("wheels", "/joint_states")));
}

TEST(TopicChoice, TakesWhatIsAskedForThenWhatTheSheetNames) {
  RecordingTopics sheet;
  sheet.camera = "/camera/image_raw/compressed";
  sheet.imu = "/imu/other";  // without messages: not recorded
  sheet.truth = "/odom";
  const TopicChoice choice = chosen(sheet, {{"wheels", "/odom"}, {"truth", "none"}});
  EXPECT_THAT(choice, ElementsAre(Pair("camera", "/camera/image_raw/compressed"), Pair("lidar", "/points"),
                                  Pair("wheels", "/odom")));
}

TEST(TopicChoice, ErrorsNameTheNearestAndTheCandidates) {
  const auto fails = [](const RecordingTopics& sheet, const std::map<std::string, std::string>& overrides,
                        const std::vector<RecordedTopic>& topics, auto matcher) {
    EXPECT_THAT([&] { chosen(sheet, overrides, topics); }, ThrowsMessage<InputError>(matcher));
  };
  fails({}, {{"lidar", "/point"}}, kRecorded, HasSubstr("did you mean /points?"));
  fails({}, {{"imu", "/points"}}, kRecorded, AllOf(HasSubstr("no imu"), HasSubstr("/imu/data")));
  RecordingTopics sheet;
  sheet.lidar = "/velodyne";
  fails(sheet, {}, kRecorded, AllOf(HasSubstr("/velodyne"), HasSubstr("it has: /points")));
  std::vector<RecordedTopic> two = kRecorded;
  two.push_back({"/points_behind", "sensor_msgs/PointCloud2", 5});
  fails({}, {}, two, AllOf(HasSubstr("/points, /points_behind"), HasSubstr("--topic lidar=")));
  fails({}, {}, {{"/text", "std_msgs/String", 9}}, AllOf(HasSubstr("no LiDAR"), HasSubstr("/text")));
}

}  // namespace
}  // namespace vsslam

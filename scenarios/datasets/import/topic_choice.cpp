#include "scenarios/datasets/import/topic_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/config.h"
#include "core/errors.h"

namespace vsslam {

namespace {

using Names = std::vector<std::string>;

struct Role {
  std::string sensor, in_sheet;
  Names types;  ///< that the sensor may have
  Names guess;  ///< of these, those that are guessed without a name
};

std::vector<Role> roles(const RecordingTopics& sheet) {
  const Names images = {"sensor_msgs/Image", "sensor_msgs/CompressedImage"};
  return {
      {"lidar", sheet.lidar, {"sensor_msgs/PointCloud2"}, {"sensor_msgs/PointCloud2"}},
      {"imu", sheet.imu, {"sensor_msgs/Imu"}, {"sensor_msgs/Imu"}},
      {"wheels", sheet.wheels, {"sensor_msgs/JointState", "nav_msgs/Odometry"}, {"sensor_msgs/JointState"}},
      {"camera", sheet.camera, images, images},
      {"truth", sheet.truth, {"nav_msgs/Odometry", "geometry_msgs/PoseStamped"}, {}}};
}

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Names of_types(const std::vector<RecordedTopic>& topics, const Names& types) {
  Names names;
  for (const RecordedTopic& topic : topics)
    if (topic.messages > 0 && has(types, topic.type)) names.push_back(topic.name);
  return names;
}

std::string listed(const Names& names) {
  return names.empty() ? "it has none" : fmt::format("it has: {}", fmt::join(names, ", "));
}

// An image that is there raw need not be read compressed; depth is no picture.
Names pictures(const Names& names) {
  Names kept;
  for (const std::string& name : names) {
    if (name.find("depth") != std::string::npos) continue;
    if (name.ends_with("/compressed") && has(names, name.substr(0, name.rfind('/')))) continue;
    kept.push_back(name);
  }
  return kept;
}

[[noreturn]] void fail_unknown(const Role& role, const std::string& name, const Names& candidates,
                               const std::vector<RecordedTopic>& topics, const std::string& file) {
  Names all;
  for (const RecordedTopic& topic : topics) all.push_back(topic.name);
  if (has(all, name))
    throw InputError(fmt::format("{}: topic {} is no {} ({}; {})", file, name, role.sensor,
                                 fmt::join(role.types, " or "), listed(candidates)));
  const std::string near = nearest(name, all);
  throw InputError(fmt::format("{}: no topic {} for the {} ({}{})", file, name, role.sensor,
                               near.empty() ? "" : fmt::format("did you mean {}? ", near),
                               listed(candidates)));
}

std::string guess(const Role& role, const std::vector<RecordedTopic>& topics, const std::string& file,
                  Names& notes) {
  Names candidates = of_types(topics, role.guess);
  if (role.sensor == "camera") candidates = pictures(candidates);
  if (candidates.empty()) return {};
  if (candidates.size() > 1)
    throw InputError(fmt::format("{}: which topic is the {}? One of {}: choose with --topic {}=NAME", file,
                                 role.sensor, fmt::join(candidates, ", "), role.sensor));
  notes.push_back(fmt::format("{}: topic {}, the only one of its type", role.sensor, candidates.front()));
  return candidates.front();
}

std::string choose(const Role& role, const std::vector<RecordedTopic>& topics,
                   const std::map<std::string, std::string>& overrides, const std::string& file,
                   Names& notes) {
  const Names candidates = of_types(topics, role.types);
  if (const auto asked = overrides.find(role.sensor); asked != overrides.end()) {
    if (asked->second == "none") return {};
    if (!has(candidates, asked->second)) fail_unknown(role, asked->second, candidates, topics, file);
    return asked->second;
  }
  if (role.in_sheet.empty()) return guess(role, topics, file, notes);
  if (has(candidates, role.in_sheet)) return role.in_sheet;
  if (role.sensor == "lidar") fail_unknown(role, role.in_sheet, candidates, topics, file);
  notes.push_back(fmt::format("{}: not recorded (no messages on the sheet's topic {}{})", role.sensor, role.in_sheet,
                              candidates.empty() ? ""
                                                 : fmt::format("; recorded: {}, take it with --topic {}={}",
                                                               fmt::join(candidates, ", "), role.sensor, candidates.front())));
  return {};
}

}  // namespace

TopicChoice choose_topics(const std::vector<RecordedTopic>& topics, const RecordingTopics& sheet,
                          const std::map<std::string, std::string>& overrides, const std::string& file,
                          std::vector<std::string>& notes) {
  TopicChoice choice;
  for (const Role& role : roles(sheet))
    if (const std::string topic = choose(role, topics, overrides, file, notes); !topic.empty())
      choice[role.sensor] = topic;
  if (choice.contains("lidar")) return choice;
  Names all;
  for (const RecordedTopic& topic : topics) all.push_back(fmt::format("{} ({})", topic.name, topic.type));
  throw InputError(
      fmt::format("{}: no LiDAR: no messages of sensor_msgs/PointCloud2 ({})", file, listed(all)));
}

}  // namespace vsslam

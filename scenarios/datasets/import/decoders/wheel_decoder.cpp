#include "scenarios/datasets/import/decoders/wheel_decoder.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace vsslam {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::optional<double> mean_position(const JointStateMessage& joints, std::string_view side) {
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < joints.name.size() && i < joints.position.size(); ++i)
    if (lower(joints.name[i]).find(side) != std::string::npos) sum += joints.position[i], ++count;
  if (count == 0) return std::nullopt;
  return sum / count;
}

}  // namespace

std::optional<WheelSample> wheels_of_joints(const JointStateMessage& joints) {
  const auto left = mean_position(joints, "left"), right = mean_position(joints, "right");
  if (!left || !right) return std::nullopt;
  return WheelSample{joints.header.stamp, *left, *right};
}

WheelSample TwistIntegrator::add(const OdometryMessage& odometry) {
  WheelSample now = last_.value_or(WheelSample{});
  now.stamp = odometry.header.stamp;
  if (last_ && now.stamp > last_->stamp) {
    const double dt_s = seconds_between(last_->stamp, now.stamp);
    const double forward_m = odometry.linear_velocity_child.x() * dt_s;
    const double across_m = 0.5 * wheels_.effective_track_m * odometry.angular_velocity_child.z() * dt_s;
    now.left_rad += (forward_m - across_m) / wheels_.wheel_radius_m;
    now.right_rad += (forward_m + across_m) / wheels_.wheel_radius_m;
  }
  last_ = now;
  return now;
}

}  // namespace vsslam

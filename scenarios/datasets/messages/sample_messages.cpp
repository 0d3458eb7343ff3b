#include "scenarios/datasets/messages/sample_messages.h"

#include <cmath>
#include <cstring>

namespace vsslam {

namespace {

constexpr uint32_t kPointBytes = 22;

Covariance3 diagonal(double xy, double z) {
  return {xy, 0, 0, 0, xy, 0, 0, 0, z};
}

double squared(double v) {
  return v * v;
}

TransformsMessage::Transform mount(const SE3& T_base_sensor, const std::string& base,
                                   const std::string& sensor, Time stamp) {
  return {{.stamp = stamp, .frame_id = base}, sensor, T_base_sensor};
}

}  // namespace

PointCloudMessage cloud_message(const LidarScan& scan, const std::string& frame_id) {
  using Field = PointCloudMessage::Field;
  PointCloudMessage cloud;
  cloud.header = {.stamp = scan.stamp, .frame_id = frame_id};
  cloud.width = static_cast<uint32_t>(scan.points.size());
  cloud.fields = {{"x", 0, Field::f32, 1},          {"y", 4, Field::f32, 1},     {"z", 8, Field::f32, 1},
                  {"intensity", 12, Field::f32, 1}, {"ring", 16, Field::u16, 1}, {"time", 18, Field::f32, 1}};
  cloud.point_step = kPointBytes;
  cloud.row_step = kPointBytes * cloud.width;
  cloud.data.resize(cloud.row_step);
  uint8_t* out = cloud.data.data();
  for (const LidarPoint& point : scan.points) {
    std::memcpy(out, &point.x, 4);
    std::memcpy(out + 4, &point.y, 4);
    std::memcpy(out + 8, &point.z, 4);
    std::memcpy(out + 12, &point.intensity, 4);
    std::memcpy(out + 16, &point.ring, 2);
    std::memcpy(out + 18, &point.time_s, 4);
    out += kPointBytes;
  }
  return cloud;
}

ImuMessage imu_message(const ImuSample& sample, const ImuDeviations& deviations,
                       const std::string& frame_id) {
  ImuMessage message;
  message.header = {.stamp = sample.stamp, .frame_id = frame_id};
  if (sample.q_earth_imu) {
    message.orientation = *sample.q_earth_imu;
    message.orientation_covariance =
        diagonal(squared(deviations.roll_pitch_rad), squared(deviations.heading_rad));
  } else {
    message.orientation_covariance[0] = -1;
  }
  message.angular_velocity = sample.gyro_radps;
  message.angular_velocity_covariance =
      diagonal(squared(deviations.gyro_radps), squared(deviations.gyro_radps));
  message.linear_acceleration = sample.accel_mps2;
  message.linear_acceleration_covariance =
      diagonal(squared(deviations.accel_mps2), squared(deviations.accel_mps2));
  return message;
}

ImageMessage image_message(const CameraFrame& frame, const std::string& frame_id) {
  ImageMessage image;
  image.header = {.stamp = frame.stamp, .frame_id = frame_id};
  image.height = static_cast<uint32_t>(frame.height_px);
  image.width = image.step = static_cast<uint32_t>(frame.width_px);
  image.encoding = "mono8";
  image.data = frame.grey;
  return image;
}

CameraInfoMessage camera_info_message(const CameraCalibration& camera, Time stamp,
                                      const std::string& frame_id) {
  CameraInfoMessage info;
  info.header = {.stamp = stamp, .frame_id = frame_id};
  info.height = static_cast<uint32_t>(camera.height_px);
  info.width = static_cast<uint32_t>(camera.width_px);
  info.d = {camera.k1, camera.k2, camera.p1, camera.p2, 0};
  info.k = {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
  info.p = {camera.fx_px, 0, camera.cx_px, 0, 0, camera.fy_px, camera.cy_px, 0, 0, 0, 1, 0};
  return info;
}

JointStateMessage joint_message(const WheelSample& sample, const std::string& frame_id) {
  JointStateMessage joints;
  joints.header = {.stamp = sample.stamp, .frame_id = frame_id};
  joints.name = {"left_wheel", "right_wheel"};
  joints.position = {sample.left_rad, sample.right_rad};
  return joints;
}

TransformsMessage static_transforms(const RigCalibration& rig, const MessageNames& names, bool camera,
                                    Time stamp) {
  TransformsMessage message;
  message.transforms = {mount(rig.lidar.T_base_lidar, names.base_frame, names.lidar_frame, stamp),
                        mount(rig.imu.T_base_imu, names.base_frame, names.imu_frame, stamp)};
  if (camera)
    message.transforms.push_back(
        mount(rig.camera.T_base_camera, names.base_frame, names.camera_frame, stamp));
  return message;
}

OdometryMessage WheelOdometry::add(const WheelSample& sample, const MessageNames& names) {
  OdometryMessage message;
  message.header = {.stamp = sample.stamp, .frame_id = names.odom_frame};
  message.child_frame_id = names.base_frame;
  if (started_) {
    const double left_m = wheels_.wheel_radius_m * (sample.left_rad - last_.left_rad);
    const double right_m = wheels_.wheel_radius_m * (sample.right_rad - last_.right_rad);
    const double forward_m = 0.5 * (left_m + right_m),
                 turn_rad = (right_m - left_m) / wheels_.effective_track_m;
    x_m_ += forward_m * std::cos(yaw_rad_ + 0.5 * turn_rad);
    y_m_ += forward_m * std::sin(yaw_rad_ + 0.5 * turn_rad);
    yaw_rad_ += turn_rad;
    if (const double dt_s = seconds_between(last_.stamp, sample.stamp); dt_s > 0) {
      message.linear_velocity_child.x() = forward_m / dt_s;
      message.angular_velocity_child.z() = turn_rad / dt_s;
    }
  }
  message.T_parent_child = SE3::from_rpy({0, 0, yaw_rad_}, {x_m_, y_m_, 0});
  last_ = sample;
  started_ = true;
  return message;
}

}  // namespace vsslam

#include "scenarios/datasets/export/sinks/message_sink.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace vsslam {

namespace {

ImuDeviations deviations_of(const ImuConfig& imu) {
  const double per_sample = std::sqrt(imu.rate_hz), rad_per_deg = std::numbers::pi / 180;
  return {.gyro_radps = imu.gyro_noise_radps_rthz * per_sample,
          .accel_mps2 = imu.accel_noise_mps2_rthz * per_sample,
          .roll_pitch_rad = imu.roll_pitch_sigma_deg * rad_per_deg,
          .heading_rad = imu.heading_sigma_deg * rad_per_deg};
}

template <class Sample>
Sample on_dataset_time(Sample sample) {
  sample.stamp = dataset_time(sample.stamp);
  return sample;
}

}  // namespace

MessageSink::MessageSink(const DatasetFacts& facts, std::unique_ptr<MessageWriter> writer)
    : names_(facts.names),
      rig_(facts.rig),
      deviations_(deviations_of(facts.scenario.rig.sensors.imu)),
      camera_(facts.has_camera()),
      odometry_(facts.rig.wheels),
      writer_(std::move(writer)) {}

void MessageSink::put(const std::string& topic, Time recorded, MessageContent content) {
  std::visit(
      [&](auto& message) {
        if constexpr (requires { message.header; }) message.header.seq = next_seq(topic);
      },
      content);
  writer_->write({topic, recorded, std::move(content)});
}

void MessageSink::write(const DatasetSample& sample) {
  if (!begun_) {
    const Time begin = dataset_time(Time{0});
    writer_->write({names_.static_transforms, begin, static_transforms(rig_, names_, camera_, begin)}, true);
    begun_ = true;
  }
  base_ = sample.base;
  std::visit([&](const auto& measurement) { write(measurement, dataset_time(sample.end)); },
             sample.measurement);
}

void MessageSink::write(const ImuMeasurement& imu, Time recorded) {
  put(names_.imu, recorded, imu_message(on_dataset_time(imu.sample), deviations_, names_.imu_frame));
}

void MessageSink::write(const WheelMeasurement& wheels, Time recorded) {
  const WheelSample sample = on_dataset_time(wheels.sample);
  put(names_.joints, recorded, joint_message(sample, names_.base_frame));
  put(names_.odometry, recorded, odometry_.add(sample, names_));
}

// With the truth of the base at the scan's stamp.
void MessageSink::write(const LidarMeasurement& lidar, Time recorded) {
  PointCloudMessage cloud = cloud_message(lidar.scan, names_.lidar_frame);
  cloud.header.stamp = dataset_time(lidar.scan.stamp);
  put(names_.points, recorded, std::move(cloud));
  OdometryMessage truth;
  truth.header = {.stamp = dataset_time(lidar.scan.stamp), .frame_id = names_.world_frame};
  truth.child_frame_id = names_.base_frame;
  truth.T_parent_child = base_.T_world_base;
  truth.linear_velocity_child = base_.T_world_base.rotation.conjugate() * base_.v_world;
  truth.angular_velocity_child = base_.omega_base;
  put(names_.truth, recorded, std::move(truth));
}

void MessageSink::write(const CameraMeasurement& camera, Time recorded) {
  ImageMessage image = image_message(camera.frame, names_.camera_frame);
  image.header.stamp = dataset_time(camera.frame.stamp);
  put(names_.camera_info, recorded,
      camera_info_message(rig_.camera, image.header.stamp, names_.camera_frame));
  put(names_.image, recorded, std::move(image));
}

}  // namespace vsslam

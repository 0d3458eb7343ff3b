// Samples as robot messages: what a bag says of each measurement. Stamps are taken over as they are.
#pragma once

#include <string>

#include "core/calibration.h"
#include "scenarios/datasets/messages/messages.h"
#include "sensors/measurement/samples.h"

namespace vsslam {

/// Topics and frames of a dataset. Defaults: ours; systems have names of their own.
struct MessageNames {
  std::string points = "/velodyne_points", imu = "/imu/data", image = "/camera/image_raw",
              camera_info = "/camera/camera_info", joints = "/joint_states", odometry = "/odom",
              static_transforms = "/tf_static", truth = "/truth/odometry";
  std::string lidar_frame = "lidar", imu_frame = "imu", camera_frame = "camera", base_frame = "base",
              odom_frame = "odom", world_frame = "world";
};

/// Deviations of an IMU's samples, for the covariances.
struct ImuDeviations {
  double gyro_radps = 0, accel_mps2 = 0;  ///< of one sample
  double roll_pitch_rad = 0, heading_rad = 0;
};

/// Layout that drivers of rotating LiDARs share: x y z intensity float32, ring uint16, time float32 (s after the stamp);
/// 22 bytes a point without gaps, in the scan's order.
PointCloudMessage cloud_message(const LidarScan& scan, const std::string& frame_id);
/// Without an orientation of the device: identity, and -1 as first element of its covariance.
ImuMessage imu_message(const ImuSample& sample, const ImuDeviations& deviations, const std::string& frame_id);
/// mono8.
ImageMessage image_message(const CameraFrame& frame, const std::string& frame_id);
/// plumb_bob.
CameraInfoMessage camera_info_message(const CameraCalibration& camera, Time stamp,
                                      const std::string& frame_id);
/// Joints left_wheel and right_wheel; position: accumulated rotation, rad.
JointStateMessage joint_message(const WheelSample& sample, const std::string& frame_id);
/// base -> lidar, imu and, if asked for, camera.
TransformsMessage static_transforms(const RigCalibration& rig, const MessageNames& names, bool camera,
                                    Time stamp);

/// Dead reckoning of a differential drive, from the first sample on: each step turns by half, advances, turns by half.
class WheelOdometry {
 public:
  explicit WheelOdometry(const WheelCalibration& wheels) : wheels_(wheels) {}
  /// Stamps must rise. The twist is the mean since the sample before.
  OdometryMessage add(const WheelSample& sample, const MessageNames& names);

 private:
  WheelCalibration wheels_;
  bool started_ = false;
  WheelSample last_;
  double x_m_ = 0, y_m_ = 0, yaw_rad_ = 0;
};

}  // namespace vsslam

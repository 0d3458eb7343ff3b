// What the simulated sensors deliver: the sample that the estimator may see, and its truth beside it.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "core/samples.h"
#include "worlds/world.h"

namespace vsslam {

/// Truth of one LiDAR point.
struct PointTruth {
  Vec3f position_lidar =
      Vec3f::Zero();  ///< noise-free point, undistorted: in the LiDAR frame at the scan's true stamp
  Vec3f normal_lidar = Vec3f::Zero();  ///< unit surface normal towards the sensor, in the same frame
  float range_m = 0;                   ///< noise-free, along the beam's centre from where it crosses the axis
  float cos_incidence = 0;
  uint32_t object = 0;    ///< index into World::objects
  uint32_t triangle = 0;  ///< index within the object, primitives one after another
  uint16_t material = 0;
};

struct LidarMeasurement {
  LidarScan scan;
  Time true_stamp;                ///< differs from scan.stamp where the sensor's clock is wrong
  SE3 T_world_lidar;              ///< truth at true_stamp
  std::vector<PointTruth> truth;  ///< one per scan.points, same order; empty if it was left out
};

struct ImuMeasurement {
  ImuSample sample;
  Time true_stamp;
  Vec3 true_gyro_radps = Vec3::Zero(), true_accel_mps2 = Vec3::Zero();  ///< noise-free
  Vec3 gyro_bias_radps = Vec3::Zero(), accel_bias_mps2 = Vec3::Zero();
};

struct WheelMeasurement {
  WheelSample sample;
  Time true_stamp;
  double slip_left_mps = 0, slip_right_mps = 0;
};

struct CameraMeasurement {
  CameraFrame frame;
  Time true_stamp;     ///< middle of the exposure
  Time end;            ///< of the exposure, true time
  SE3 T_world_camera;  ///< truth at true_stamp
  double exposure_s = 0, gain = 1;
  // At true_stamp, row-major; empty unless the settings ask for them.
  std::vector<float> clean_grey;  ///< the image without blur, noise and quantisation, 0 .. 255
  std::vector<float> depth_m;     ///< along the camera's z axis; infinite: nothing there
  /// Where each pixel's static point was one period of the camera earlier, minus where it is: px. Infinite where it was
  /// behind the camera; empty if there was no truth then. Backwards, because an image is delivered before the next pose
  /// exists.
  std::vector<Vec2f> flow_px;
};

using Measurement = std::variant<ImuMeasurement, WheelMeasurement, LidarMeasurement, CameraMeasurement>;

}  // namespace vsslam

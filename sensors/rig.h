// The sensors on the robot: mounts, rates, noise; and the stream of measurements in order of time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/calibration.h"
#include "core/config.h"
#include "sensors/camera/camera_config.h"
#include "sensors/imu.h"
#include "sensors/lidar/lidar_config.h"
#include "sensors/measurement/samples.h"
#include "sensors/measurement/sensor_events.h"
#include "sensors/ray/raycaster.h"
#include "sensors/wheel_encoder.h"
#include "sim/trajectory.h"
#include "sim/wheel_state.h"
#include "worlds/lighting.h"

namespace vsslam {

struct MountConfig {
  Vec3 position_m = Vec3::Zero();  ///< of the sensor's origin in the base frame
  Vec3 rpy_deg = Vec3::Zero();
  SE3 T_base_sensor() const;
  void fields(Fields& f);
};

/// The `rig` section of a scenario, and the content of sensors/library/*.yaml.
struct RigConfig {
  struct Sensors {
    LidarConfig lidar;
    ImuConfig imu;
    WheelEncoderConfig wheels;
    CameraConfig camera;
    void fields(Fields& f);
  } sensors;
  struct Mounts {
    // On a Scout 2.0: LiDAR on a post, camera in front of it, IMU in the middle of the deck.
    MountConfig lidar{{0.10, 0, 0.45}, Vec3::Zero()};
    MountConfig imu{{0, 0, 0.12}, Vec3::Zero()};
    MountConfig camera{{0.32, 0, 0.30}, {-90, 0, -90}};
    void fields(Fields& f);
  } mounts;

  void fields(Fields& f);  ///< starts with f.base("rigs", *this)
  /// What the estimator is told.
  RigCalibration calibration(double wheel_radius_m, double effective_track_m, double base_height_m) const;
};

/// What an earlier run has delivered already. Such scans come without points and such images without pixels instead of
/// being rendered; all else, and what follows, is as if they had been.
struct TakenBefore {
  std::function<bool(int64_t index, Time stamp)> scan{};  ///< index: among the scans delivered so far; empty: none
  /// Mean grey of the image, on which later exposures depend. Called from several threads at once; empty: none.
  std::function<std::optional<double>(Time stamp)> image{};
};

/// Samples all sensors from the truth trajectory.
class Rig {
 public:
  /// The world must outlive the rig. Throws InputError if an event names an object that the world has not, or,
  /// if there is a camera, a group of lights. Only a camera needs the lighting; its light maps are baked here.
  Rig(const World& world, const RigConfig& config, const SensorEvents& events, uint64_t seed,
      const LightingConfig& lighting = {});
  ~Rig();

  /// Emits every measurement whose acquisition ends at or before `until`, in order of the end of its
  /// acquisition (ties: IMU, wheels, LiDAR, camera), as far as the trajectory reaches; the rest follows with the next
  /// call. Measuring starts at trajectory.begin() of the first call, but not before time 0. Objects with
  /// events are where they are at the beginning of each LiDAR scan and in the middle of each image's exposure.
  void advance(Time until, const Trajectory& trajectory, const std::function<WheelState(Time)>& wheels,
               const std::function<void(Measurement&&)>& sink);
  /// Earliest time of the truth that is still needed.
  Time needed_from() const;
  Raycaster& raycaster();
  /// Before the first advance. Stamps are those that the sensors' clocks give.
  void leave_out(TakenBefore taken);
  /// Before the first advance: scans come without the truth of their points.
  void leave_out_point_truth();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

// Visual-inertial odometry: a sliding window of key frames with inverse depths, preintegrated IMU and a
// marginalisation prior (Qin, Li, Shen, T-RO 2018; depth from the LiDAR as in Shan et al., ICRA 2021).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/calibration.h"
#include "core/config.h"
#include "core/samples.h"
#include "core/stage_clock.h"
#include "slam/inertial/imu_track.h"
#include "slam/inertial/preintegration.h"
#include "slam/vision/visual_frame.h"

namespace vsslam {

/// The robot stands still if its IMU is quiet and its image does not flow, both for `window_s`.
struct VioRestConfig {
  double window_s = 0.4;
  double gyro_radps = 0.02;          ///< spread of the gyroscope, and bound of its mean ...
  double accel_mps2 = 0.15;          ///< ... and spread of the accelerometer
  double gyro_change_radps = 0.005;  ///< of the mean over a quarter of the window
  double accel_change_mps2 = 0.02;   ///< likewise
  double flow_px = 1.5;              ///< median displacement of features, at focal length 460
  /// While tracking it must also have slowed down to this: what lies far ahead does not flow either, and at
  /// constant speed an IMU is as quiet.
  double speed_mps = 0.05;
  void fields(Fields& f);
};

struct VioStartConfig {
  double max_aid_age_s = 0.5;
  double aid_tilt_sigma_rad = 0.005;
  double aid_velocity_sigma_mps = 0.1;
  double gyro_bias_sigma_radps = 0.004;  ///< what a bias may be when nothing is known of it
  double accel_bias_sigma_mps2 = 0.04;
  double motion_s = 1.0;                ///< shortest time over which a start from motion looks back
  double motion_velocity_sigma = 0.15;  ///< of a start from motion, of the speed; worse -> wait
  void fields(Fields& f);
};

/// Beyond these the odometry has failed and restarts.
struct VioLimits {
  int min_tracks = 8;    ///< with fewer an image counts as blind
  double blind_s = 0.7;  ///< for so long the IMU alone carries
  double gyro_bias_radps = 1.0;
  double accel_bias_mps2 = 2.5;
  double speed_mps = 30.0;
  double jump_m = 1.0;  ///< of a frame from where the IMU expected it
  double jump_rad = 0.35;
  void fields(Fields& f);
};

/// Pixels are at a focal length of 460, as published, whatever the camera.
struct VioConfig {
  int window = 10;                  ///< key frames beside the newest frame
  double max_rate_hz = 10;          ///< of frames that enter the window; the others cost nothing
  double time_offset_s = 0;         ///< camera clock + offset = IMU clock
  double feature_sigma_px = 1.5;    ///< of a feature's position
  double depth_sigma_ratio = 0.03;  ///< of a LiDAR depth, of the depth
  double imu_noise_factor = 1.0;    ///< on the densities of the calibration
  double key_parallax_px = 10;      ///< a key frame moved this far on average, without rotation ...
  int key_tracks = 20;              ///< ... or sees fewer features of the window ...
  double key_interval_s = 2;        ///< ... or comes this long after the last
  int max_features = 120;           ///< in the optimisation; the longest tracks win
  double outlier_px = 3;            ///< mean error of a feature that leaves
  int max_iterations = 8;
  VioRestConfig rest;
  VioStartConfig start;
  VioLimits limits;
  void fields(Fields& f);
};

/// State of the IMU. The frame `vio` has z up; where it is and how it is turned about z is arbitrary, and it
/// changes with every restart.
struct VioState {
  Time stamp;  ///< by the IMU's clock
  SE3 T_vio_imu;
  Vec3 v_vio_mps = Vec3::Zero();
  ImuBias bias;
};

/// What the LiDAR odometry knows at one instant, for a start without waiting for parallax. T_odom_imu and the
/// velocity of the IMU are in a frame with z up, which becomes the frame `vio`.
struct VioAid {
  Time stamp;
  SE3 T_odom_imu;
  Vec3 v_odom_mps = Vec3::Zero();
  ImuBias bias;
};

enum class VioStatus { starting, tracking };

/// Deterministic: the same samples give the same bytes. Not thread-safe.
class VisualInertialOdometry {
 public:
  VisualInertialOdometry(const VioConfig& config, const RigCalibration& rig,
                         const ImuTrackLimits& limits = {}, StageClock* clock = nullptr);
  ~VisualInertialOdometry();

  /// Samples that are not finite or not newer than the last are ignored.
  void add(const ImuSample& sample);
  /// The latest knowledge of the LiDAR side; used at the next start or restart, ignored while tracking.
  void add(const VioAid& aid);
  /// Whether a frame with this stamp would enter the window: `max_rate_hz` limits how many do.
  bool wants(Time stamp) const;
  /// Frames in order of time, after the IMU samples up to their stamp; others are ignored. The state at the
  /// frame, if tracking.
  std::optional<VioState> add(const VisualFrame& frame);

  VioStatus status() const;
  int restarts() const;  ///< failures after a successful start
  /// State at the last frame of the window; only while tracking.
  const VioState& state() const;
  /// Of state(), tangent order [pose; velocity; gyro bias; accel bias]. Costs about as much as a frame.
  Eigen::Matrix<double, 15, 15> covariance() const;
  /// Poses from one instant to a later one: window states, preintegrated IMU between and beyond them. Empty
  /// if not tracking over the whole time. Relative motion is what counts; all in one frame `vio`.
  std::vector<StampedPose> path_vio_imu(Time begin, Time end) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

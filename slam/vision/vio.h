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
#include "slam/inertial/preintegration.h"
#include "slam/vision/visual_frame.h"

namespace vsslam {

struct VioConfig {
  int window = 10;
  void fields(Fields& f);
};

/// State of the IMU. The frame `vio` has z up; where it is and how it is turned about z is arbitrary, and it
/// changes with every restart.
struct VioState {
  Time stamp;
  SE3 T_vio_imu;
  Vec3 v_vio_mps = Vec3::Zero();
  ImuBias bias;
};

/// What the LiDAR odometry knows at one instant, for a start without waiting for parallax. T_odom_imu and the
/// velocity are in a frame with z up, which becomes the frame `vio`.
struct VioAid {
  Time stamp;
  SE3 T_odom_imu;
  Vec3 v_odom_mps = Vec3::Zero();
  ImuBias bias;
};

enum class VioStatus { starting, tracking };

class VisualInertialOdometry {
 public:
  VisualInertialOdometry(const VioConfig& config, const RigCalibration& rig, StageClock* clock = nullptr);
  ~VisualInertialOdometry();

  void add(const ImuSample& sample);
  /// The latest knowledge of the LiDAR side; used at the next start or restart, ignored while tracking.
  void add(const VioAid& aid);
  /// Frames in order of time, after the IMU samples up to their stamp. The state at the frame, if tracking.
  std::optional<VioState> add(const VisualFrame& frame);

  VioStatus status() const;
  int restarts() const;  ///< failures after a successful start
  /// State at the last frame of the window; only while tracking.
  const VioState& state() const;
  /// Poses from one instant to a later one: window states, preintegrated IMU between and beyond them. Empty
  /// if not tracking over the whole time. Relative motion is what counts; all in one frame `vio`.
  std::vector<StampedPose> path_vio_imu(Time begin, Time end) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

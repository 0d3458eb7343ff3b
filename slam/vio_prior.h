// The prior `vio`: visual-inertial odometry, helped by the LiDAR's depths; IMU and wheels while it restarts.
#pragma once

#include <optional>

#include "core/stage_clock.h"
#include "slam/inertial/imu_prior.h"
#include "slam/vision_config.h"

namespace vsslam {

class VioPrior : public MotionPrior {
 public:
  VioPrior(const VisionConfig& config, const InertialConfig& inertial, const RigCalibration& rig,
           StageClock* clock);

  void start(const InitialState& state) override;
  void add(const ImuSample& sample) override;
  void add(const WheelSample& sample) override { fallback_.add(sample); }
  void add(const CameraFrame& image) override;
  MotionPath path(Time begin, Time end) const override;
  Mat6 covariance(Time end) const override;
  Mat6 step_covariance(Time end) const override;
  void correct(const OdometryFix& fix) override;
  void add_scan(Time stamp, const Cloud& points_lidar, const SE3& T_odom_base) override;
  int64_t slips() const override { return fallback_.slips(); }
  bool stood() const override { return fallback_.stood(); }
  std::optional<Eigen::Vector2d> imu_noise() const override { return fallback_.imu_noise(); }
  std::optional<VisualReport> visual_report() const override;

 private:
  std::optional<MotionPath> visual_path_since_fix(Time end) const;
  std::optional<MotionPath> visual_path(Time begin, Time end) const;
  std::optional<Quat> camera_turn(Time from, Time to) const;
  void fill_depth(Time stamp, VisualFrame& frame) const;  // by the clock of the IMU
  VioAid aid(const OdometryFix& fix, const Vec3& unseen_velocity_base_mps) const;

  VisionConfig config_;
  RigCalibration rig_;
  StageClock* clock_;
  FeatureTracker tracker_;
  LidarDepth depth_;
  VisualInertialOdometry vio_;
  ImuPrior fallback_;
  ImuTrack imu_;
  std::optional<Time> last_image_;
  SE3 T_start_base_;  // the prior's own motions, one after another, up to the last fix
};

}  // namespace vsslam

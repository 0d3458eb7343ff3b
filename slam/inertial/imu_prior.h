// The prior `imu`: preintegrated IMU with the velocity that the LiDAR odometry shows.
#pragma once

#include "slam/inertial/fix_history.h"
#include "slam/inertial/gyro_bias.h"
#include "slam/inertial/imu_track.h"
#include "slam/inertial/motion_prior.h"
#include "slam/inertial/preintegration.h"

namespace vsslam {

class ImuPrior : public MotionPrior {
 public:
  ImuPrior(const InertialConfig& config, const RigCalibration& rig);

  void start(const InitialState& state) override;
  void add(const ImuSample& sample) override { imu_.add(sample); }
  MotionPath path(Time begin, Time end) const override;
  void correct(const OdometryFix& fix) override;

 private:
  /// Pose and velocity of the IMU's origin.
  struct State {
    SE3 T_odom_imu;
    Vec3 v_odom = Vec3::Zero();
  };
  /// Appends the motion to `path` if given. False if samples are missing.
  bool predict(Time begin, Time end, State& state, MotionPath* path) const;
  void correct_velocity(const OdometryFix& fix, const State& predicted, const State& measured, double dt_s);

  InertialConfig config_;
  ImuCalibration imu_calibration_;
  ImuTrack imu_;
  GyroBias gyro_bias_;
  Vec3 accel_bias_mps2_ = Vec3::Zero();  // as at the start
  FixHistory fixes_;
  State state_;  // at the last fix
  double velocity_variance_ = 1.0;
};

}  // namespace vsslam

// Rotation from the gyroscope, translation from the wheels, each optional: the priors `wheel_imu` (both),
// `wheel` (wheels alone, yaw from the effective track) and `constant_velocity` (neither).
#pragma once

#include "slam/inertial/fix_history.h"
#include "slam/inertial/gyro_bias.h"
#include "slam/inertial/imu_track.h"
#include "slam/inertial/motion_prior.h"
#include "slam/inertial/wheel_track.h"

namespace vsslam {

class DeadReckoning : public MotionPrior {
 public:
  DeadReckoning(const InertialConfig& config, const RigCalibration& rig, bool use_gyro, bool use_wheels);

  void start(const InitialState& state) override;
  void add(const ImuSample& sample) override;
  void add(const WheelSample& sample) override;
  MotionPath path(Time begin, Time end) const override;
  Mat6 covariance(Time end) const override;
  void correct(const OdometryFix& fix) override;
  const Vec3& gyro_bias_radps() const { return gyro_bias_.bias_radps(); }
  const FixHistory& fixes() const { return fixes_; }

 private:
  std::vector<Time> knot_stamps(Time begin, Time end) const;
  Vec3 omega_base(Time a, Time b, const Vec6& fallback) const;
  Vec3 step_base(Time a, Time b, const Vec6& fallback) const;

  InertialConfig config_;
  ImuCalibration imu_sheet_;
  bool use_gyro_, use_wheels_;
  SE3 T_base_imu_;
  ImuTrack imu_;
  WheelTrack wheels_;
  GyroBias gyro_bias_;
  FixHistory fixes_;
};

}  // namespace vsslam

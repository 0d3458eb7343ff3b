// Without IMU: turn and way from the wheels (prior `wheel`), or as the last two fixes say (`constant_velocity`).
#pragma once

#include "slam/inertial/fix_history.h"
#include "slam/inertial/motion_prior.h"
#include "slam/inertial/wheel_track.h"

namespace vsslam {

/// How well wheels know a way, base frame: how far, less well whether up, down or aside.
Vec3 way_sigma_m(const InertialConfig& config, double way_m, double turn_rad);

class DeadReckoning : public MotionPrior {
 public:
  DeadReckoning(const InertialConfig& config, const RigCalibration& rig, bool use_wheels);

  void start(const InitialState&) override {}
  void add(const WheelSample& sample) override;
  MotionPath path(Time begin, Time end) const override;
  Mat6 covariance(Time end) const override;
  Mat6 step_covariance(Time end) const override;
  void correct(const OdometryFix& fix) override;
  /// Displacement by the wheels while the robot turned as in `path`, base frame at its begin. Nothing if samples are missing.
  std::optional<Vec3> way(const MotionPath& path) const;
  /// The same without the direction: rolled forward or back from one to the other.
  std::optional<double> rolled_m(Time from, Time to) const;
  const FixHistory& fixes() const { return fixes_; }

 private:
  Mat6 covariance(Time end, const Mat6& last_pose, Mat6 unmeasured) const;
  InertialConfig config_;
  bool use_wheels_;
  WheelTrack wheels_;
  FixHistory fixes_;
};

}  // namespace vsslam

// The last pose of the odometry and the velocity up to it: what any prior falls back on, and the prior
// `constant_velocity` itself. A Kalman filter of pose and twist, whose poses the registrations give.
#pragma once

#include <optional>

#include "slam/inertial/motion_prior.h"

namespace vsslam {

class FixHistory {
 public:
  explicit FixHistory(const InertialConfig& config) : config_(config) {}

  /// What the twist is before the second fix nobody knows.
  void add(const OdometryFix& fix);

  const std::optional<OdometryFix>& last() const { return last_; }
  /// Of the base, body frame, [rad/s; m/s]; zero until there are two fixes.
  const Vec6& twist() const { return twist_; }
  /// Of T_odom_base at `end`, the twist continued from the last fix; right perturbation.
  Mat6 covariance(Time end) const;
  /// Of the motion since then alone.
  Mat6 step_covariance(Time end) const;

 private:
  using Mat12 = Eigen::Matrix<double, 12, 12>;
  Mat12 predicted(const Mat12& P, double dt_s) const;

  InertialConfig config_;
  std::optional<OdometryFix> last_;
  Vec6 twist_ = Vec6::Zero();
  bool moving_known_ = false;
  Mat12 P_ = Mat12::Zero();  // of [pose; twist]
};

}  // namespace vsslam

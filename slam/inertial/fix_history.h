// The last two poses of the odometry and the velocity between them: what any prior falls back on.
#pragma once

#include <optional>

#include "slam/inertial/motion_prior.h"

namespace vsslam {

class FixHistory {
 public:
  void add(const OdometryFix& fix) {
    before_ = last_;
    last_ = fix;
  }
  const std::optional<OdometryFix>& last() const { return last_; }
  const std::optional<OdometryFix>& before() const { return before_; }
  /// Twist of the base, body frame, [rad/s; m/s]; zero until there are two fixes.
  Vec6 twist() const {
    if (!before_ || before_->stamp >= last_->stamp) return Vec6::Zero();
    const SE3 T_before_last = before_->T_odom_base.inverse() * last_->T_odom_base;
    return T_before_last.log() / seconds_between(before_->stamp, last_->stamp);
  }

 private:
  std::optional<OdometryFix> before_, last_;
};

}  // namespace vsslam

// The last pose of the odometry and the velocity up to it: what any prior falls back on.
#pragma once

#include <optional>

#include "slam/inertial/motion_prior.h"

namespace vsslam {

class FixHistory {
 public:
  /// The velocity is smoothed by half. An error e_k of a pose enters the next scan's undistortion as velocity,
  /// and from there its pose, e_k+1 = -(e_k - e_k-1) / 2 unsmoothed, which rings for ever (a root at -1).
  void add(const OdometryFix& fix) {
    if (last_ && fix.stamp > last_->stamp) {
      const Vec6 motion = (last_->T_odom_base.inverse() * fix.T_odom_base).log();
      const Vec6 twist = motion / seconds_between(last_->stamp, fix.stamp);
      twist_ = 0.5 * (twist_ + twist);
    }
    last_ = fix;
  }
  const std::optional<OdometryFix>& last() const { return last_; }
  /// Of the base, body frame, [rad/s; m/s]; zero until there are two fixes.
  const Vec6& twist() const { return twist_; }

 private:
  std::optional<OdometryFix> last_;
  Vec6 twist_ = Vec6::Zero();
};

}  // namespace vsslam

#include "slam/inertial/fix_history.h"

#include "slam/inertial/pose_covariance.h"

namespace vsslam {

// The velocity changes by up to a dt from interval to interval, and is steady within one: a shift is taken for a wrong
// velocity, once. (With a steady acceleration instead it would be taken for twice the velocity, at the interval's end.)
FixHistory::Mat12 FixHistory::predicted(const Mat12& before, double dt_s) const {
  Mat12 P = before;
  const double turn_radps = config_.unknown_turn_radps2 * dt_s, speed_mps = config_.unknown_accel_mps2 * dt_s;
  P.diagonal().segment<3>(6).array() += turn_radps * turn_radps;
  P.diagonal().tail<3>().array() += speed_mps * speed_mps;
  Mat12 F = Mat12::Identity();
  F.topLeftCorner<6, 6>() = SE3::exp(twist_ * dt_s).inverse().adjoint();
  F.topRightCorner<6, 6>() = dt_s * Mat6::Identity();
  return F * P * F.transpose();
}

Mat6 FixHistory::covariance(Time end) const {
  if (!last_) return Mat6::Identity();
  return predicted(P_, seconds_between(last_->stamp, end)).topLeftCorner<6, 6>();
}

Mat6 FixHistory::step_covariance(Time end) const {
  if (!last_) return Mat6::Identity();
  return predicted(of_exact_pose(P_), seconds_between(last_->stamp, end)).topLeftCorner<6, 6>();
}

void FixHistory::add(const OdometryFix& fix) {
  if (!last_ || fix.stamp <= last_->stamp) {
    const double turn_radps = config_.max_turn_radps / 3, speed_mps = config_.max_speed_mps / 3;
    P_.setZero();
    P_.topLeftCorner<6, 6>() = fix.covariance;
    P_.diagonal().segment<3>(6).setConstant(turn_radps * turn_radps);
    P_.diagonal().tail<3>().setConstant(speed_mps * speed_mps);
    last_ = fix;
    return;
  }
  const double dt_s = seconds_between(last_->stamp, fix.stamp);
  P_ = predicted(P_, dt_s);
  const SE3 predicted_pose = last_->T_odom_base * SE3::exp(twist_ * dt_s);
  const Vec6 shift = (predicted_pose.inverse() * fix.T_odom_base).log();
  const Vec6 change = condition_on_pose(P_, shift, fix.covariance).tail<6>();
  // An error e_k of a pose enters the next scan's undistortion as velocity, and from there its pose: taken over whole,
  // e_k+1 = -(e_k - e_k-1) / 2 rings for ever (a root at -1). Taken over by half the roots are 0.64 and -0.39.
  twist_ += moving_known_ ? 0.5 * change : change;
  if (!(twist_.tail<3>().norm() < config_.max_speed_mps)) twist_.setZero();
  moving_known_ = true;
  last_ = fix;
}

}  // namespace vsslam

#include "slam/inertial/wheel_track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vsslam {

namespace {

void go_on(double last_rad, double& angle_rad, double& turns_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  angle_rad += turns_rad;
  const double step_rad = angle_rad - last_rad;
  // A step of about a turn; other leaps are no wrap.
  if (std::abs(step_rad) < 0.5 * kTurn || std::abs(step_rad) > 1.5 * kTurn) return;
  turns_rad -= std::copysign(kTurn, step_rad);
  angle_rad -= std::copysign(kTurn, step_rad);
}

}  // namespace

WheelSample WheelTurns::unwrapped(WheelSample sample) {
  if (last_) {
    go_on(last_->left_rad, sample.left_rad, left_turns_rad_);
    go_on(last_->right_rad, sample.right_rad, right_turns_rad_);
  }
  last_ = sample;
  return sample;
}

void WheelTrack::add(const WheelSample& sample) {
  if (!std::isfinite(sample.left_rad) || !std::isfinite(sample.right_rad)) return;
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return;
  if (!samples_.empty()) usual_gap_.add(seconds_between(samples_.back().stamp, sample.stamp));
  samples_.push_back(turns_.unwrapped(sample));
}

void WheelTrack::forget_before(Time stamp) {
  while (samples_.size() >= 3 && samples_[2].stamp <= stamp) samples_.pop_front();
}

WheelTravel WheelTrack::travel(double left_rad, double right_rad) const {
  const double left_m = wheels_.wheel_radius_m * left_rad, right_m = wheels_.wheel_radius_m * right_rad;
  return {0.5 * (left_m + right_m), (right_m - left_m) / wheels_.effective_track_m};
}

std::optional<WheelTravel> WheelTrack::at(Time stamp) const {
  if (samples_.size() < 2 || stamp < samples_.front().stamp) return std::nullopt;
  auto after = std::lower_bound(samples_.begin() + 1, samples_.end(), stamp,
                                [](const WheelSample& s, Time t) { return s.stamp < t; });
  if (after == samples_.end()) {
    if (seconds_between(samples_.back().stamp, stamp) > 0.5 * max_gap_s()) return std::nullopt;
    --after;
  }
  const WheelSample& a = *(after - 1);
  const WheelSample& b = *after;
  const double gap_s = seconds_between(a.stamp, b.stamp);
  if (gap_s > max_gap_s()) return std::nullopt;
  const double u = seconds_between(a.stamp, stamp) / gap_s;
  return travel(a.left_rad + u * (b.left_rad - a.left_rad), a.right_rad + u * (b.right_rad - a.right_rad));
}

}  // namespace vsslam

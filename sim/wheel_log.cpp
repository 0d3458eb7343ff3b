#include "sim/wheel_log.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace vsslam {

namespace {

WheelState read_wheels(const RobotState& state) {
  const auto side = [](const std::array<double, 4>& of_wheel, Wheel front, Wheel rear) {
    return 0.5 * (of_wheel[front] + of_wheel[rear]);
  };
  return {.left_rad = side(state.wheel_rad, kFrontLeft, kRearLeft),
          .right_rad = side(state.wheel_rad, kFrontRight, kRearRight),
          .left_radps = side(state.wheel_radps, kFrontLeft, kRearLeft),
          .right_radps = side(state.wheel_radps, kFrontRight, kRearRight),
          .slip_left_mps = side(state.slip_mps, kFrontLeft, kRearLeft),
          .slip_right_mps = side(state.slip_mps, kFrontRight, kRearRight)};
}

WheelState mix(const WheelState& a, const WheelState& b, double u) {
  const auto between = [u](double from, double to) { return from + u * (to - from); };
  return {.left_rad = between(a.left_rad, b.left_rad),
          .right_rad = between(a.right_rad, b.right_rad),
          .left_radps = between(a.left_radps, b.left_radps),
          .right_radps = between(a.right_radps, b.right_radps),
          .slip_left_mps = between(a.slip_left_mps, b.slip_left_mps),
          .slip_right_mps = between(a.slip_right_mps, b.slip_right_mps)};
}

Vec2 rotate(double rad, const Vec2& v) {
  return {std::cos(rad) * v.x() - std::sin(rad) * v.y(), std::sin(rad) * v.x() + std::cos(rad) * v.y()};
}

}  // namespace

PlanarPose relative(const PlanarPose& a, const PlanarPose& b) {
  return {rotate(-a.yaw_rad, b.position_m - a.position_m), wrap_angle(b.yaw_rad - a.yaw_rad)};
}

PlanarPose compose(const PlanarPose& a, const PlanarPose& b) {
  return {a.position_m + rotate(a.yaw_rad, b.position_m), wrap_angle(a.yaw_rad + b.yaw_rad)};
}

void WheelLog::push(Time stamp, const RobotState& state) {
  Entry entry{read_wheels(state), {}};
  if (entries_.empty()) {
    first_ns_ = stamp.ns;
  } else {
    const Entry& before = entries_.back();
    const double r = scout_.wheel_radius_m;
    const double left_m = r * (entry.wheels.left_rad - before.wheels.left_rad);
    const double right_m = r * (entry.wheels.right_rad - before.wheels.right_rad);
    entry.odom =
        compose(before.odom, {{0.5 * (left_m + right_m), 0}, (right_m - left_m) / effective_track_m(scout_)});
  }
  entries_.push_back(entry);
}

void WheelLog::forget_before(Time stamp) {
  constexpr size_t kKept = kKept_ns / Dynamics::kStep_ns;
  while (entries_.size() > kKept && first_ns_ + Dynamics::kStep_ns <= stamp.ns) {
    entries_.pop_front();
    first_ns_ += Dynamics::kStep_ns;
  }
}

WheelLog WheelLog::since(Time stamp) const {
  WheelLog log(scout_);
  const int64_t skipped = std::clamp<int64_t>((stamp.ns - first_ns_) / Dynamics::kStep_ns, 0,
                                              static_cast<int64_t>(entries_.size()));
  log.first_ns_ = first_ns_ + skipped * Dynamics::kStep_ns;
  log.entries_.assign(entries_.begin() + skipped, entries_.end());
  return log;
}

WheelState WheelLog::at(Time stamp) const {
  const int64_t since_first_ns = stamp.ns - first_ns_;
  const int64_t last_ns = Dynamics::kStep_ns * (static_cast<int64_t>(entries_.size()) - 1);
  if (since_first_ns < 0 || since_first_ns > last_ns) {
    std::fprintf(stderr, "wheels: asked for %lld ns, known from %lld to %lld ns\n",
                 static_cast<long long>(stamp.ns), static_cast<long long>(first_ns_),
                 static_cast<long long>(first_ns_ + last_ns));
    std::abort();
  }
  const size_t i = static_cast<size_t>(since_first_ns / Dynamics::kStep_ns);
  const double u = static_cast<double>(since_first_ns % Dynamics::kStep_ns) / Dynamics::kStep_ns;
  return mix(entries_[i].wheels, entries_[std::min(i + 1, entries_.size() - 1)].wheels, u);
}

PlanarPose WheelLog::moved_since(Time since) const {
  const int64_t index = std::clamp<int64_t>((since.ns - first_ns_) / Dynamics::kStep_ns, 0,
                                            static_cast<int64_t>(entries_.size()) - 1);
  return relative(entries_[static_cast<size_t>(index)].odom, entries_.back().odom);
}

}  // namespace vsslam

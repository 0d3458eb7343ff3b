#include "sensors/wheel_encoder.h"

#include <cmath>
#include <numbers>

#include "core/rng.h"

namespace vsslam {

void WheelEncoderConfig::fields(Fields& f) {
  f("rate_hz", rate_hz, between(1, 1000));
  f("ticks_per_turn", ticks_per_turn, non_negative());
  f("radius_sigma", radius_sigma, between(0, 0.1));
}

WheelEncoder::WheelEncoder(const WheelEncoderConfig& config, uint64_t seed) : config_(config) {
  const RandomStream radius(seed, "wheel radius");
  left_scale_ = 1.0 / (1.0 + config.radius_sigma * radius.normal(0));
  right_scale_ = 1.0 / (1.0 + config.radius_sigma * radius.normal(1));
}

Time WheelEncoder::stamp(int64_t index) const {
  return Time{std::llround(static_cast<double>(index) * (1e9 / config_.rate_hz))};
}

int64_t WheelEncoder::first_index(Time at_or_after) const {
  auto index = static_cast<int64_t>(std::floor(at_or_after.seconds() * config_.rate_hz)) - 1;
  while (stamp(index) < at_or_after) ++index;
  return index;
}

WheelMeasurement WheelEncoder::measure(int64_t index, const WheelState& state) const {
  const double step_rad = config_.ticks_per_turn > 0 ? 2 * std::numbers::pi / config_.ticks_per_turn : 0;
  const auto counted = [&](double angle_rad) {
    return step_rad > 0 ? std::floor(angle_rad / step_rad) * step_rad : angle_rad;
  };
  WheelMeasurement m;
  m.sample = {stamp(index), counted(left_scale_ * state.left_rad), counted(right_scale_ * state.right_rad)};
  m.true_stamp = stamp(index);
  m.slip_left_mps = state.slip_left_mps;
  m.slip_right_mps = state.slip_right_mps;
  return m;
}

}  // namespace vsslam

#include "sensors/lidar_rotation.h"

#include <cmath>
#include <numbers>

namespace vsslam {

namespace {
constexpr double kRadPerTurn = 2 * std::numbers::pi;
}

void CycleAzimuths::Turning::resize(size_t cycles) {
  cosine.resize(cycles);
  sine.resize(cycles);
  step_rad.resize(cycles);
}

LidarRotation::LidarRotation(const LidarConfig& config, uint64_t seed)
    : cycle_s_(1e-9 * static_cast<double>(laser_table(config.model).cycle_ns)),
      turns_per_cycle_(config.rate_hz * cycle_s_),
      cycles_per_block_(laser_table(config.model).cycles_per_block),
      step_turns_(config.azimuth_step_deg / 360),
      jitter_turns_(config.azimuth_jitter_sigma_deg / 360),
      wander_turns_(config.rotation_wander_sigma_deg / 360),
      wander_(RandomStream(seed, "lidar.rotation_wander"), config.rotation_wander_time_s),
      jitter_(seed, "lidar.azimuth_jitter") {}

double LidarRotation::turns(int64_t cycle) const {
  const double even = static_cast<double>(cycle - origin_cycle_) * turns_per_cycle_;
  if (wander_turns_ == 0) return even;
  return even + wander_turns_ * wander_.at(static_cast<double>(cycle) * cycle_s_) - origin_wander_turns_;
}

double LidarRotation::reported_turns(int64_t block) const {
  double reading = turns(origin_cycle_ + block * cycles_per_block_);
  if (jitter_turns_ > 0) {
    const uint64_t bits = jitter_.bits(static_cast<uint64_t>(origin_cycle_), static_cast<uint64_t>(block));
    reading += jitter_turns_ * NormalTable::instance()(bits);
  }
  return step_turns_ > 0 ? std::round(reading / step_turns_) * step_turns_ : reading;
}

Revolution LidarRotation::power_on(int64_t first_cycle) {
  origin_cycle_ = first_cycle;
  origin_wander_turns_ = wander_turns_ * wander_.at(static_cast<double>(first_cycle) * cycle_s_);
  return revolution_from(0, first_cycle);
}

Revolution LidarRotation::after(const Revolution& revolution) const {
  return revolution_from(revolution.index + 1, revolution.first_cycle + revolution.cycles);
}

Revolution LidarRotation::revolution_from(int64_t index, int64_t first_cycle) const {
  const auto limit = static_cast<double>(index + 1);
  int64_t next = first_cycle + static_cast<int64_t>((limit - turns(first_cycle)) / turns_per_cycle_);
  while (turns(next) < limit) ++next;
  while (turns(next - 1) >= limit) --next;
  return {index, first_cycle, next - first_cycle};
}

void LidarRotation::azimuths(const Revolution& revolution, CycleAzimuths& out) const {
  const auto cycles = static_cast<size_t>(revolution.cycles);
  out.actual.resize(cycles);
  out.reported.resize(cycles);
  const double whole = static_cast<double>(revolution.index);
  double now = turns(revolution.first_cycle) - whole;
  int64_t block = -1;
  double block_begin = 0, block_end = 0;
  for (size_t i = 0; i < cycles; ++i) {
    const int64_t cycle = revolution.first_cycle + static_cast<int64_t>(i);
    const double next = turns(cycle + 1) - whole;
    const double angle_rad = -kRadPerTurn * now;
    out.actual.cosine[i] = std::cos(angle_rad);
    out.actual.sine[i] = std::sin(angle_rad);
    out.actual.step_rad[i] = -kRadPerTurn * (next - now);

    // A block reports the azimuth of its first cycle; what follows is interpolated, as drivers do.
    const int64_t in_block = (cycle - origin_cycle_) % cycles_per_block_;
    if (const int64_t b = (cycle - origin_cycle_) / cycles_per_block_; b != block) {
      block_begin = b == block + 1 && block >= 0 ? block_end : reported_turns(b) - whole;
      block_end = reported_turns(b + 1) - whole;
      block = b;
    }
    const double step = (block_end - block_begin) / cycles_per_block_;
    const double off_rad = -kRadPerTurn * (block_begin + step * static_cast<double>(in_block) - now);
    const double c = std::cos(off_rad), s = std::sin(off_rad);
    out.reported.cosine[i] = c * out.actual.cosine[i] - s * out.actual.sine[i];
    out.reported.sine[i] = c * out.actual.sine[i] + s * out.actual.cosine[i];
    out.reported.step_rad[i] = -kRadPerTurn * step;
    now = next;
  }
}

}  // namespace vsslam

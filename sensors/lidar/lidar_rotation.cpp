#include "sensors/lidar/lidar_rotation.h"

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

void CycleAzimuths::Turning::set(size_t cycle, double angle_rad, double step) {
  cosine[cycle] = std::cos(angle_rad);
  sine[cycle] = std::sin(angle_rad);
  step_rad[cycle] = step;
}

void CycleAzimuths::Turning::repeat(size_t cycle) {
  cosine[cycle] = cosine[cycle - 1];
  sine[cycle] = sine[cycle - 1];
  step_rad[cycle] = step_rad[cycle - 1];
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

double LidarRotation::turns(int64_t cycle, SlowNoise::Cache& cache) const {
  const double even = static_cast<double>(cycle - origin_cycle_) * turns_per_cycle_;
  if (wander_turns_ == 0) return even;
  return even + wander_turns_ * wander_.at(static_cast<double>(cycle) * cycle_s_, 0, cache) -
         origin_wander_turns_;
}

double LidarRotation::reported_turns(int64_t block, double actual_turns) const {
  double reading = actual_turns;
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
  SlowNoise::Cache cache;
  const auto limit = static_cast<double>(index + 1);
  int64_t next = first_cycle + static_cast<int64_t>((limit - turns(first_cycle, cache)) / turns_per_cycle_);
  while (turns(next, cache) < limit) ++next;
  while (turns(next - 1, cache) >= limit) --next;
  return {index, first_cycle, next - first_cycle};
}

void LidarRotation::azimuths(const Revolution& revolution, CycleAzimuths& out) const {
  const auto cycles = static_cast<size_t>(revolution.cycles);
  const size_t padded = (cycles + 15) / 16 * 16;
  out.actual.resize(padded);
  out.reported.resize(padded);
  const auto whole = static_cast<double>(revolution.index);
  SlowNoise::Cache cache, cache_ahead;
  const auto reading = [&](int64_t block) {
    return reported_turns(block, turns(origin_cycle_ + block * cycles_per_block_, cache_ahead)) - whole;
  };
  double now = turns(revolution.first_cycle, cache) - whole;
  int64_t block = (revolution.first_cycle - origin_cycle_) / cycles_per_block_;
  double block_begin = reading(block), block_end = reading(block + 1);
  for (size_t i = 0; i < cycles; ++i) {
    const int64_t since_origin = revolution.first_cycle + static_cast<int64_t>(i) - origin_cycle_;
    const double next = turns(origin_cycle_ + since_origin + 1, cache) - whole;
    // A block reports the azimuth of its first cycle; what follows is interpolated, as drivers do.
    if (since_origin / cycles_per_block_ != block) {
      block = since_origin / cycles_per_block_;
      block_begin = block_end;
      block_end = reading(block + 1);
    }
    const double reported_step = (block_end - block_begin) / cycles_per_block_;
    const double reported =
        block_begin + reported_step * static_cast<double>(since_origin % cycles_per_block_);
    out.actual.set(i, -kRadPerTurn * now, -kRadPerTurn * (next - now));
    out.reported.set(i, -kRadPerTurn * reported, -kRadPerTurn * reported_step);
    now = next;
  }
  for (size_t i = cycles; i < padded; ++i) out.actual.repeat(i), out.reported.repeat(i);
}

}  // namespace vsslam

#include "sensors/lidar/lidar_errors.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

// Beyond 5 sigma nothing is drawn: an echo that strong is always seen, one that weak never.
constexpr float kDetectionSigmas = 5;

}  // namespace

IncidenceBias incidence_bias(double cos_incidence) {
  constexpr double kDetector_m = 7.08e-3, kFootprint = 1.32e-5, kCosLast = 0.0871557;  // 85 deg
  const double c = std::clamp(cos_incidence, kCosLast, 1.0);
  return {kDetector_m * (1 / c - 1), kFootprint * (1 / (c * c) - 1)};
}

double incidence_bias_m(double cos_incidence, double range_m) {
  const IncidenceBias bias = incidence_bias(cos_incidence);
  return bias.constant_m + bias.per_m * range_m;
}

LidarErrors::LidarErrors(const LidarConfig& config, size_t lasers, uint64_t seed)
    : config_(config),
      range_noise_(seed, "lidar.range"),
      detection_noise_(seed, "lidar.detection"),
      intensity_noise_(seed, "lidar.intensity"),
      normal_(NormalTable::instance()),
      detection_gain_(static_cast<float>(config.detection_range_m * config.detection_range_m / 0.1)) {
  const RandomStream bias(seed, "lidar.laser_bias");
  for (size_t laser = 0; laser < lasers; ++laser)
    laser_bias_m_.push_back(static_cast<float>(config.laser_bias_sigma_m * bias.normal(laser)));
  for (size_t i = 0; i <= kBiasCells; ++i) {
    const auto [constant_m, per_m] = incidence_bias(static_cast<double>(i) / kBiasCells);
    bias_constant_m_[i] = static_cast<float>(config.incidence_bias_scale * constant_m);
    bias_per_m_[i] = static_cast<float>(config.incidence_bias_scale * per_m);
  }
}

// Received power against the threshold; random only where noise can decide.
void LidarErrors::detect(const EchoPacket& echo, size_t laser, int64_t first_cycle,
                         int (&any)[kLanes]) const {
  const auto sigma = static_cast<float>(config_.detection_sigma);
  const float sure = 1 / (1 - kDetectionSigmas * sigma), never = 1 / (1 + kDetectionSigmas * sigma);
  float margin[kLanes];
  int unsure = 0;
#pragma GCC ivdep
  for (int i = 0; i < kLanes; ++i) {
    margin[i] = echo.power[i] * detection_gain_ / (echo.mean_range_m[i] * echo.mean_range_m[i]);
    const int strong = margin[i] > sure ? 1 : 0, weak = margin[i] < never ? 1 : 0;
    unsure += echo.any[i] & ~strong & ~weak;
    any[i] = echo.any[i] & strong;
  }
  if (unsure == 0) return;
  for (int i = 0; i < kLanes; ++i) {
    if (!echo.any[i] || margin[i] > sure || margin[i] < never) continue;
    const float draw = normal_(detection_noise_.bits(static_cast<uint64_t>(first_cycle + i), laser));
    any[i] = margin[i] * (1 + sigma * std::clamp(draw, -kDetectionSigmas, kDetectionSigmas)) > 1 ? 1 : 0;
  }
}

void LidarErrors::add_bias_and_noise(const EchoPacket& echo, size_t laser, int64_t first_cycle,
                                     float (&range_m)[kLanes]) const {
  const float bias = laser_bias_m_[laser];
  const float *const constant_at = bias_constant_m_.data(), *const per_m_at = bias_per_m_.data();
  float noise[kLanes] = {};
  const auto sigma = static_cast<float>(config_.range_sigma_m);
  if (sigma > 0) normal_.sixteen(range_noise_, first_cycle, laser, noise);
#pragma GCC ivdep
  for (int i = 0; i < kLanes; ++i) {
    const float cell = echo.cos_incidence[i] * kBiasCells, range = echo.mean_range_m[i];
    const int k = std::min(static_cast<int>(cell), kBiasCells - 1);
    const float u = cell - static_cast<float>(k);
    const float constant = constant_at[k] + u * (constant_at[k + 1] - constant_at[k]);
    const float per_m = per_m_at[k] + u * (per_m_at[k + 1] - per_m_at[k]);
    range_m[i] = range + (bias + constant + per_m * range) + sigma * noise[i];
  }
}

void LidarErrors::report(const EchoPacket& echo, size_t laser, int64_t first_cycle,
                         ReportedPacket& out) const {
  const auto low = static_cast<float>(config_.min_range_m), high = static_cast<float>(config_.max_range_m);
  if (config_.dropout)
    detect(echo, laser, first_cycle, out.any);
  else
    std::copy(std::begin(echo.any), std::end(echo.any), out.any);
  add_bias_and_noise(echo, laser, first_cycle, out.range_m);
  if (const auto step = static_cast<float>(config_.range_step_m); step > 0) {
    const float per_step = 1 / step;
#pragma GCC ivdep
    for (int i = 0; i < kLanes; ++i) out.range_m[i] = std::rint(out.range_m[i] * per_step) * step;
  }
  for (int i = 0; i < kLanes; ++i) out.any[i] &= out.range_m[i] >= low && out.range_m[i] <= high ? 1 : 0;

  float noise[kLanes] = {};
  const auto sigma = static_cast<float>(config_.intensity_sigma);
  if (sigma > 0) normal_.sixteen(intensity_noise_, first_cycle, laser, noise);
#pragma GCC ivdep
  for (int i = 0; i < kLanes; ++i) {
    const float byte = echo.reflectivity[i] + sigma * noise[i];
    const float least = echo.reflectivity[i] > 100 ? 101.0f : 0.0f;
    const float most = echo.reflectivity[i] > 100 ? 255.0f : 100.0f;
    const float above = byte > least ? byte : least;
    out.intensity[i] = std::rint(above < most ? above : most);
  }
}

}  // namespace vsslam

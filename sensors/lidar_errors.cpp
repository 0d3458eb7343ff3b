#include "sensors/lidar_errors.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

struct BiasAt10m {
  double tan_incidence, bias_m;
};
// Incidence 0, 45, 60, 75, 80, 85 deg.
constexpr BiasAt10m kBias[] = {
    {0, 0}, {1, 0.003}, {1.7320508, 0.0075}, {3.7320508, 0.022}, {5.6712818, 0.038}, {11.4300523, 0.091}};

// Beyond 5 sigma nothing is drawn: an echo that strong is always seen, one that weak never.
constexpr float kDetectionSigmas = 5;

}  // namespace

double incidence_bias_m(double cos_incidence, double range_m) {
  const double c = std::clamp(cos_incidence, 0.0, 1.0);
  const double tangent = c > 0.05 ? std::sqrt(1 - c * c) / c : 20;
  double bias = std::end(kBias)[-1].bias_m;
  for (size_t i = 1; i < std::size(kBias); ++i) {
    const BiasAt10m &low = kBias[i - 1], &high = kBias[i];
    if (tangent > high.tan_incidence) continue;
    const double u = (tangent - low.tan_incidence) / (high.tan_incidence - low.tan_incidence);
    bias = low.bias_m + u * (high.bias_m - low.bias_m);
    break;
  }
  return bias * range_m / 10;
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
  for (int i = 0; i <= kBiasCells; ++i)
    bias_per_m_[static_cast<size_t>(i)] = static_cast<float>(
        config.incidence_bias_scale * incidence_bias_m(static_cast<double>(i) / kBiasCells, 1.0));
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
  const float* const per_m_at = bias_per_m_.data();
  float noise[kLanes] = {};
  const auto sigma = static_cast<float>(config_.range_sigma_m);
  if (sigma > 0) normal_.sixteen(range_noise_, first_cycle, laser, noise);
#pragma GCC ivdep
  for (int i = 0; i < kLanes; ++i) {
    const float cell = echo.cos_incidence[i] * kBiasCells, range = echo.mean_range_m[i];
    const int k = std::min(static_cast<int>(cell), kBiasCells - 1);
    const float low = per_m_at[k], high = per_m_at[k + 1];
    const float per_m = low + (cell - static_cast<float>(k)) * (high - low);
    range_m[i] = range + (bias + per_m * range) + sigma * noise[i];
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

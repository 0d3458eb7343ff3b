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
constexpr double kDetectionSigmas = 5;

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

bool LidarErrors::detected(float power, float range_m, uint64_t cycle, size_t laser) const {
  if (!config_.dropout) return true;
  const double margin = static_cast<double>(power * detection_gain_ / (range_m * range_m));
  const double sigma = config_.detection_sigma;
  if (margin * (1 - kDetectionSigmas * sigma) > 1) return true;
  if (margin * (1 + kDetectionSigmas * sigma) < 1) return false;
  const double draw = normal_(detection_noise_.bits(cycle, laser));
  return margin * (1 + sigma * std::clamp(draw, -kDetectionSigmas, kDetectionSigmas)) > 1;
}

void LidarErrors::report(const EchoPacket& echo, size_t laser, int64_t first_cycle,
                         ReportedPacket& out) const {
  const float bias = laser_bias_m_[laser];
  const auto sigma = static_cast<float>(config_.range_sigma_m);
  const auto intensity_sigma = static_cast<float>(config_.intensity_sigma);
  const auto step = static_cast<float>(config_.range_step_m), per_step = step > 0 ? 1 / step : 0.0f;
  const auto low = static_cast<float>(config_.min_range_m), high = static_cast<float>(config_.max_range_m);
  for (int i = 0; i < kLanes; ++i) {
    out.any[i] = 0;
    if (!echo.any[i]) continue;
    const auto cycle = static_cast<uint64_t>(first_cycle + i);
    float range = echo.mean_range_m[i];
    if (!detected(echo.power[i], range, cycle, laser)) continue;
    // The table ends are exact, so that head-on hits have no bias at all.
    const float cell = echo.cos_incidence[i] * kBiasCells;
    const auto k = std::min(static_cast<size_t>(cell), static_cast<size_t>(kBiasCells - 1));
    const float per_m =
        bias_per_m_[k] + (cell - static_cast<float>(k)) * (bias_per_m_[k + 1] - bias_per_m_[k]);
    range += bias + per_m * range;
    if (sigma > 0) range += sigma * static_cast<float>(normal_(range_noise_.bits(cycle, laser)));
    if (step > 0) range = std::nearbyint(range * per_step) * step;
    if (range < low || range > high) continue;

    const bool retro = echo.reflectivity[i] > 100;
    float byte = echo.reflectivity[i];
    if (intensity_sigma > 0)
      byte += intensity_sigma * static_cast<float>(normal_(intensity_noise_.bits(cycle, laser)));
    out.any[i] = 1;
    out.range_m[i] = range;
    out.intensity[i] = std::nearbyint(std::clamp(byte, retro ? 101.0f : 0.0f, retro ? 255.0f : 100.0f));
  }
}

}  // namespace vsslam

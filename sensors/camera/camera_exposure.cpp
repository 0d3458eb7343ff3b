#include "sensors/camera/camera_exposure.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

Duration even(double seconds) {
  return {2 * std::max<int64_t>(1, std::llround(seconds * 0.5e9))};
}

}  // namespace

ExposureControl::ExposureControl(const CameraConfig& config)
    : config_(config.auto_exposure), gamma_(config.gamma), product_s_(config.exposure_s * config.gain) {
  const Exposure fixed{even(config.exposure_s), config.gain};
  const int known = config_.enabled ? config_.delay_frames : AutoExposureConfig{}.delay_frames;
  for (int i = 0; i < known; ++i) settings_.push_back(config_.enabled ? clamped(product_s_) : fixed);
}

Exposure ExposureControl::clamped(double product_s) const {
  const double time_s =
      std::clamp(product_s / config_.min_gain, config_.min_exposure_s, config_.max_exposure_s);
  const Duration time = even(time_s);
  return {time, std::clamp(product_s / time.seconds(), config_.min_gain, config_.max_gain)};
}

void ExposureControl::push(double product_s) {
  product_s_ = std::clamp(product_s, config_.min_exposure_s * config_.min_gain,
                          config_.max_exposure_s * config_.max_gain);
  settings_.push_back(clamped(product_s_));
  settings_.pop_front();
}

void ExposureControl::saw(double mean_grey) {
  if (!config_.enabled) return;
  const double wish_s =
      settings_.front().product_s() * std::pow(config_.target_grey / std::max(mean_grey, 0.5), gamma_);
  push(product_s_ * std::pow(wish_s / product_s_, config_.share_per_frame));
}

void ExposureControl::missed() {
  if (config_.enabled) push(product_s_);
}

}  // namespace vsslam

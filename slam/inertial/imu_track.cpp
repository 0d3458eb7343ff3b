#include "slam/inertial/imu_track.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

double median_of_three(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

void replace_spike(const Vec3& before, Vec3& middle, const Vec3& after, double limit) {
  Vec3 median;
  for (int k = 0; k < 3; ++k) median[k] = median_of_three(before[k], middle[k], after[k]);
  if ((middle - median).norm() > limit) middle = median;
}

}  // namespace

ImuTrackLimits track_limits(const InertialConfig& config) {
  return {config.spike_gyro_radps, config.spike_accel_mps2, config.max_gap_s};
}

void ImuTrack::add(const ImuSample& sample) {
  if (!sample.gyro_radps.allFinite() || !sample.accel_mps2.allFinite()) return;
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return;
  if (doubted_) samples_.back() = *doubted_;
  doubted_.reset();
  if (!samples_.empty()) usual_gap_.add(seconds_between(samples_.back().stamp, sample.stamp));
  samples_.push_back(sample);
  if (samples_.size() >= 3) remove_spike(samples_.size() - 2);
  doubt_newest();
}

// Whether it is a spike or the first of many, the next sample will tell.
void ImuTrack::doubt_newest() {
  if (samples_.size() < 2) return;
  ImuSample& newest = samples_.back();
  const ImuSample& before = samples_[samples_.size() - 2];
  const bool far = (newest.gyro_radps - before.gyro_radps).norm() > limits_.spike_gyro_radps ||
                   (newest.accel_mps2 - before.accel_mps2).norm() > limits_.spike_accel_mps2;
  if (!far || seconds_between(before.stamp, newest.stamp) > max_gap_s()) return;
  doubted_ = newest;
  newest.gyro_radps = before.gyro_radps;
  newest.accel_mps2 = before.accel_mps2;
}

void ImuTrack::remove_spike(size_t middle) {
  const ImuSample& before = samples_[middle - 1];
  const ImuSample& after = samples_[middle + 1];
  if (seconds_between(before.stamp, after.stamp) > 2.0 * max_gap_s()) return;
  replace_spike(before.gyro_radps, samples_[middle].gyro_radps, after.gyro_radps, limits_.spike_gyro_radps);
  replace_spike(before.accel_mps2, samples_[middle].accel_mps2, after.accel_mps2, limits_.spike_accel_mps2);
}

void ImuTrack::forget_before(Time stamp) {
  while (samples_.size() >= 2 && samples_[1].stamp <= stamp) samples_.pop_front();
}

std::optional<ImuSample> ImuTrack::at(Time stamp) const {
  if (samples_.empty()) return std::nullopt;
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), stamp,
                                      [](const ImuSample& s, Time t) { return s.stamp < t; });
  if (after == samples_.begin() || after == samples_.end()) {
    const ImuSample& nearest = after == samples_.end() ? samples_.back() : samples_.front();
    if (std::abs(seconds_between(nearest.stamp, stamp)) > 0.5 * max_gap_s()) return std::nullopt;
    return ImuSample{stamp, nearest.gyro_radps, nearest.accel_mps2, std::nullopt};
  }
  const ImuSample& a = *(after - 1);
  const ImuSample& b = *after;
  const double gap_s = seconds_between(a.stamp, b.stamp);
  if (gap_s > max_gap_s()) return std::nullopt;
  const double u = seconds_between(a.stamp, stamp) / gap_s;
  return ImuSample{stamp, a.gyro_radps + u * (b.gyro_radps - a.gyro_radps),
                   a.accel_mps2 + u * (b.accel_mps2 - a.accel_mps2), std::nullopt};
}

}  // namespace vsslam

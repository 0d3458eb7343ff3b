#include "slam/inertial/imu_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vsslam {

namespace {

// Squared density from second differences of samples dt_s apart, whose variance is 6 times that of white noise: what a
// robot does on purpose is nearly straight over three samples, shaking at tens of Hz is not. By the median, so that
// corners and spikes do not count.
double density2(std::vector<double>& second_differences, double dt_s) {
  constexpr double kMedianOfNormal = 0.6745;
  const auto middle = second_differences.begin() + static_cast<std::ptrdiff_t>(second_differences.size() / 2);
  std::nth_element(second_differences.begin(), middle, second_differences.end());
  const double sigma = *middle / kMedianOfNormal;
  return sigma * sigma / 6 * dt_s;
}

}  // namespace

ImuNoise::ImuNoise(const ImuCalibration& sheet, std::optional<double> factor)
    : sheet_gyro_(sheet.gyro_noise_radps_rthz),
      sheet_accel_(sheet.accel_noise_mps2_rthz),
      measures_(!factor),
      gyro_density_(factor.value_or(1) * sheet_gyro_),
      accel_density_(factor.value_or(1) * sheet_accel_) {}

void ImuNoise::listen(const std::deque<ImuSample>& samples, Time from, Time to) {
  constexpr size_t kEnough = 12;  // four samples of three axes: a median of fewer is a guess
  constexpr int kMemory = 100;    // spans: ten seconds of scans
  if (!measures_) return;
  std::vector<double> gyro, accel;
  double dt_s = 0;
  for (size_t i = 2; i < samples.size(); ++i) {
    const ImuSample &a = samples[i - 2], &b = samples[i - 1], &c = samples[i];
    if (a.stamp < from || c.stamp > to) continue;
    const double first_s = seconds_between(a.stamp, b.stamp), second_s = seconds_between(b.stamp, c.stamp);
    if (std::abs(first_s - second_s) > 0.5 * std::min(first_s, second_s)) continue;  // one is missing
    for (int axis = 0; axis < 3; ++axis) {
      gyro.push_back(std::abs(a.gyro_radps[axis] - 2 * b.gyro_radps[axis] + c.gyro_radps[axis]));
      accel.push_back(std::abs(a.accel_mps2[axis] - 2 * b.accel_mps2[axis] + c.accel_mps2[axis]));
    }
    dt_s = std::max(dt_s, second_s);
  }
  if (gyro.size() < kEnough) return;
  spans_ = std::min(spans_ + 1, kMemory);
  gyro_variance_ += (density2(gyro, dt_s) - gyro_variance_) / spans_;
  accel_variance_ += (density2(accel, dt_s) - accel_variance_) / spans_;
  gyro_density_ = std::max(sheet_gyro_, std::sqrt(gyro_variance_));
  accel_density_ = std::max(sheet_accel_, std::sqrt(accel_variance_));
}

}  // namespace vsslam

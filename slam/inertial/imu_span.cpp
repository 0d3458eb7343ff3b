#include "slam/inertial/imu_span.h"

#include <algorithm>

namespace vsslam {

std::optional<ImuSpan> cut_span(const ImuTrack& imu, Time begin, Time end, double max_gap_s) {
  const auto first = imu.at(begin), last = imu.at(end);
  if (!first || !last || end <= begin) return std::nullopt;
  ImuSpan span{*first};
  const auto& samples = imu.samples();
  auto sample = std::upper_bound(samples.begin(), samples.end(), begin,
                                 [](Time t, const ImuSample& s) { return t < s.stamp; });
  for (; sample != samples.end() && sample->stamp < end; ++sample) span.push_back(*sample);
  span.push_back(*last);
  for (size_t i = 1; i < span.size(); ++i)
    if (seconds_between(span[i - 1].stamp, span[i].stamp) > max_gap_s) return std::nullopt;
  return span;
}

ImuPreintegration preintegrate(const ImuSpan& span, const ImuCalibration& imu, const ImuBias& bias) {
  ImuPreintegration motion(imu, bias);
  for (size_t i = 1; i < span.size(); ++i) {
    const ImuSample &a = span[i - 1], &b = span[i];
    if (b.stamp <= a.stamp) continue;
    motion.add(seconds_between(a.stamp, b.stamp), a.gyro_radps, a.accel_mps2, b.gyro_radps, b.accel_mps2);
  }
  return motion;
}

}  // namespace vsslam

// The recent IMU samples in order of time, cleaned of what no IMU measures.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>

#include "core/samples.h"
#include "core/se3.h"
#include "slam/inertial/motion_prior.h"
#include "slam/inertial/usual_gap.h"

namespace vsslam {

/// See InertialConfig.
struct ImuTrackLimits {
  double spike_gyro_radps = 0.5;
  double spike_accel_mps2 = 20.0;
  double max_gap_s = 0.05;
};

ImuTrackLimits track_limits(const InertialConfig& config);

class ImuTrack {
 public:
  explicit ImuTrack(const ImuTrackLimits& limits) : limits_(limits) {}

  /// Ignores samples that are not finite or not newer than the last. A single sample far from the median of itself
  /// and its neighbours (taken for each axis) is replaced by it. Until the next sample is here to tell, one far from
  /// the last has the values of the last.
  void add(const ImuSample& sample);
  void clear() {
    samples_.clear();
    doubted_.reset();
  }
  /// Keeps the last sample at or before `stamp`.
  void forget_before(Time stamp);

  /// Samples further apart are a dropout: as set, or three of a slow sensor's periods.
  double max_gap_s() const { return std::max(limits_.max_gap_s, usual_gap_.longest_s()); }
  const std::deque<ImuSample>& samples() const { return samples_; }
  /// Linear between samples no further apart than the largest gap; the nearest sample up to half of that
  /// beyond the ends. Orientation is not filled.
  std::optional<ImuSample> at(Time stamp) const;

 private:
  void remove_spike(size_t middle);
  void doubt_newest();
  ImuTrackLimits limits_;
  std::deque<ImuSample> samples_;
  UsualGap usual_gap_;
  std::optional<ImuSample> doubted_;  ///< the newest sample as it came, if it does not stand so in samples_
};

}  // namespace vsslam

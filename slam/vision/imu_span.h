// The IMU between two frames.
#pragma once

#include <optional>
#include <vector>

#include "slam/inertial/imu_track.h"
#include "slam/inertial/preintegration.h"
#include "slam/vision/vio.h"

namespace vsslam {

/// Samples in order of time; the first and the last are interpolated at the ends of the interval.
using ImuSpan = std::vector<ImuSample>;

/// Longer without samples and the IMU has told nothing.
inline constexpr double kMaxImuGap_s = 0.1;

/// Nothing if samples are missing for longer than `max_gap_s`.
std::optional<ImuSpan> cut_span(const ImuTrack& imu, Time begin, Time end, double max_gap_s);

ImuPreintegration preintegrate(const ImuSpan& span, const ImuCalibration& imu, const ImuBias& bias);

/// The state after a motion that was preintegrated with about the same bias.
VioState predict(const VioState& state, const ImuPreintegration& motion, double gravity_mps2);

/// The states at the samples of a span, the first included.
std::vector<VioState> predict_along(const VioState& state, const ImuSpan& span, const ImuCalibration& imu);

}  // namespace vsslam

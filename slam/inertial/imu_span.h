// The IMU between two instants.
#pragma once

#include <optional>
#include <vector>

#include "slam/inertial/imu_track.h"
#include "slam/inertial/preintegration.h"

namespace vsslam {

/// Samples in order of time; the first and the last are interpolated at the ends of the interval.
using ImuSpan = std::vector<ImuSample>;

/// Nothing if samples are missing for longer than `max_gap_s`.
std::optional<ImuSpan> cut_span(const ImuTrack& imu, Time begin, Time end, double max_gap_s);

ImuPreintegration preintegrate(const ImuSpan& span, const ImuCalibration& imu, const ImuBias& bias);

}  // namespace vsslam

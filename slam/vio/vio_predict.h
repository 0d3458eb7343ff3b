// Where the IMU says that the next frame is.
#pragma once

#include <vector>

#include "slam/inertial/imu_span.h"
#include "slam/vio/vio.h"

namespace vsslam {

/// Longer without samples and the IMU has told nothing.
inline constexpr double kMaxImuGap_s = 0.1;

/// The state after a motion that was preintegrated with about the same bias.
VioState predict(const VioState& state, const ImuPreintegration& motion, double gravity_mps2);

/// The states at the samples of a span, the first included.
std::vector<VioState> predict_along(const VioState& state, const ImuSpan& span, const ImuCalibration& imu);

}  // namespace vsslam

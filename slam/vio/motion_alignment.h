// Velocity, gravity, scale and structure of a window in motion, in closed form.
#pragma once

#include "slam/vio/vio_problem.h"

namespace vsslam {

/// In the first IMU's frame, with rotations R_k from the gyroscope, the camera of frame k is at
///   c_k = v_0 t_k + 1/2 g t_k^2 + alpha_k + R_k t_imu_camera,
/// and a feature X seen there satisfies two equations linear in X, v_0 and g, and a third if its depth is known
/// (Dong-Si, Mourikis, IROS 2012). The features are eliminated; g is held to its known length. Needs rotations and
/// `motion` in the window, biases count as zero. The window in a frame with z up, with states and inverse depths;
/// nothing if the measurements do not tell the velocity.
std::optional<VioWindow> align_motion(const VioWindow& window, const VioModel& model);

}  // namespace vsslam

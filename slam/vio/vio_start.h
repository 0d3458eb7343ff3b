// Ways to begin: from the LiDAR's knowledge, from rest, from motion.
#pragma once

#include "slam/vio/vio_problem.h"

namespace vsslam {

/// From a state shortly before the frame. Nothing if IMU samples are missing in between.
std::optional<VioWindow> start_aided(const VioAid& aid, const VisualFrame& frame, const ImuTrack& imu,
                                     const VioModel& model);

/// Gravity and gyroscope bias from the mean of the IMU; the robot has not moved from `reference` to `frame`.
VioWindow start_at_rest(const VisualFrame& reference, const VisualFrame& frame, const RestMeans& means,
                        const VioModel& model);

/// Collects frames in motion until velocity, gravity and scale can be told.
class MotionStart {
 public:
  explicit MotionStart(const VioModel& model) : model_(model) {}
  /// A solved window if it can start with this frame.
  std::optional<VioWindow> add(const VisualFrame& frame, const ImuTrack& imu);
  void reset() { window_ = {}; }

 private:
  bool collect(const VisualFrame& frame, const ImuTrack& imu);

  VioModel model_;
  VioWindow window_;  // rotations by the gyroscope, from the identity; nothing else is known
};

}  // namespace vsslam

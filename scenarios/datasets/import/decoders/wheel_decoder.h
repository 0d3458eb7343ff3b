// Wheel angles from what robots publish of their wheels.
#pragma once

#include <optional>
#include <string_view>

#include "core/calibration.h"
#include "core/samples.h"
#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// Joints whose names have "left" and "right" in them, the mean where there are several of a side. nullopt: no such
/// joints, or no positions (other joints may share the topic).
std::optional<WheelSample> wheels_of_joints(const JointStateMessage& joints);

/// Wheel angles that a robot of this wheel radius and track would have turned by, from the twist of its wheel odometry:
/// each twist holds since the message before, as that of `export` does.
class TwistIntegrator {
 public:
  explicit TwistIntegrator(const WheelCalibration& wheels) : wheels_(wheels) {}
  WheelSample add(const OdometryMessage& odometry);

 private:
  WheelCalibration wheels_;
  std::optional<WheelSample> last_;
};

}  // namespace vsslam

// The truth of a stretch of the robot's motion, by itself: sensors sample it while the robot drives on.
#pragma once

#include "sim/trajectory.h"
#include "sim/wheel_log.h"

namespace vsslam {

struct Motion {
  Time until;  ///< measure what ends at or before this time
  Trajectory trajectory;
  WheelLog wheels;
};

}  // namespace vsslam

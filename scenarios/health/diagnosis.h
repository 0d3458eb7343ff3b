// What the facts about the sensors mean.
#pragma once

#include "core/calibration.h"
#include "scenarios/health/health.h"

namespace vsslam {

/// Adds to `warnings` what is doubtful, with what can be given to settle it, and says in `worthless` why the result is
/// worth nothing, if so.
void diagnose(const RigCalibration& rig, Health& health);

}  // namespace vsslam

// What stands on the lawn, the square and the street of a gate world.
#pragma once

#include "worlds/outdoor/gate_plan.h"
#include "worlds/outdoor/outfitter.h"

namespace vsslam {

/// Monument, flags, hedges and benches; lamps; parked cars; then trees, planters and people where they find a place.
void fit_square(Outfitter& outfitter, const GatePlan& plan, const GateConfig& config);

}  // namespace vsslam

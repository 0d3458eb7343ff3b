// The gate itself: pillars, a beam across, a booth between the lanes, raised barriers.
#pragma once

#include "worlds/kit/mesh_builder.h"
#include "worlds/kit/outdoor_palette.h"

namespace vsslam {

inline constexpr double kGateHalfWidth_m = 9.5;  ///< from the middle to the large pillars
inline constexpr double kGateLane_m = 4.5;       ///< from the middle to the middle of a lane

/// In the plane y = 0, its middle at the origin.
Mesh make_gate_structure(const OutdoorPalette& palette);

}  // namespace vsslam

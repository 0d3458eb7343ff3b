// What stands on the pavements, carriageways and lawns of a street world.
#pragma once

#include "worlds/outdoor/outfitter.h"
#include "worlds/outdoor/street_layout.h"

namespace vsslam {

/// Lamps, trees, benches, bins, signs and people along the kerb, and cars parked beside it.
void fit_roadsides(Outfitter& outfitter, const StreetLayout& layout, const StreetConfig& config);
/// Trees, hedges, benches, lamps, people and a monument on a raised lawn.
void fit_lawn(Outfitter& outfitter, const Rect& lawn, double base_m, const StreetConfig& config);
/// A fence across each gap between houses, at the front and at the back of it.
void fit_gaps(Outfitter& outfitter, const std::vector<Rect>& gaps, Facing front, double base_m);

}  // namespace vsslam

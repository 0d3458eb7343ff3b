// Where things lie in a gate world.
#pragma once

#include "worlds/kit/floor_plan.h"
#include "worlds/outdoor/gate.h"

namespace vsslam {

inline constexpr double kGatePavement_m = 0.12, kGateLawn_m = 0.15;  ///< heights

struct GatePlan {
  explicit GatePlan(const GateConfig& config) : half(config.size_m / 2), scale(config.size_m / 84) {}

  static constexpr double kApron_m = 10.8;  ///< from the fence to the street
  static constexpr double kRoad_m = 10.4, kPavementWidth_m = 3, kStreetBeyond_m = 34;

  double half, scale;
  double road_north() const { return -half - kApron_m; }
  double road_middle() const { return road_north() - kRoad_m / 2; }
  double road_south() const { return road_north() - kRoad_m; }
  double street_end() const { return half + kStreetBeyond_m; }
  Rect square() const { return {-half - 1.5, road_north(), half + 1.5, half + 1.5}; }
  Rect lawn() const { return {-20 * scale, -10 * scale, 20 * scale, 14 * scale}; }
};

}  // namespace vsslam

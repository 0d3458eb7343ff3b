// Routes that a robot can follow: straight lines joined by arcs.
#pragma once

#include <string>
#include <vector>

#include "worlds/world.h"

namespace vsslam {

/// Walks through the corners of a closed polygon, each rounded by an arc of `radius_m` (less where sides are
/// short), with a point at least every `spacing_m`. Starts in the middle of the side from the last corner
/// to the first.
Route rounded_loop(std::string name, const std::vector<Vec3>& corners_world, double radius_m,
                   double spacing_m);

/// The same through the points of an open line, whose ends are kept.
Route rounded_path(std::string name, const std::vector<Vec3>& corners_world, double radius_m,
                   double spacing_m);

/// A straight open route from a to b, both included.
Route straight_route(std::string name, const Vec3& a_world, const Vec3& b_world, double spacing_m);

/// The same path driven the other way; a closed one starts at the same point.
Route reversed(const Route& route, std::string name);

/// Length in metres, the closing side included.
double route_length_m(const Route& route);

}  // namespace vsslam

#include "sim/route_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "core/suggestion.h"

namespace vsslam {

namespace {

constexpr double kSamePoint_m = 1e-6;

const Route& route_named(const World& world, const std::string& name, const std::string& place) {
  std::vector<std::string> names;
  for (const Route& route : world.routes) {
    if (route.name == name) return route;
    names.push_back(route.name);
  }
  const std::string hint = names.empty() ? "it has none" : suggestion(name, names);
  throw InputError(fmt::format("{}: no route \"{}\" in world \"{}\" ({})", place, name, world.name, hint));
}

// Twice the area inside, positive if counterclockwise.
double signed_area(const std::vector<Vec2>& points) {
  double sum = 0;
  for (size_t i = 1; i < points.size(); ++i)
    sum += points[i - 1].x() * points[i].y() - points[i - 1].y() * points[i].x();
  return sum;
}

}  // namespace

RouteLine::RouteLine(const World& world, const std::string& name, RouteDirection direction,
                     const std::string& place)
    : name_(name) {
  const Route& route = route_named(world, name, place);
  closed_ = route.closed;
  for (const Vec3& point_world : route.points_world) {
    if (!point_world.allFinite())
      throw InputError(fmt::format("{}: route \"{}\" is not finite", place, name));
    const Vec2 point = point_world.head<2>();
    if (points_.empty() || (point - points_.back()).norm() > kSamePoint_m) points_.push_back(point);
  }
  if (closed_ && points_.size() > 1 && (points_.front() - points_.back()).norm() > kSamePoint_m)
    points_.push_back(points_.front());
  if (points_.size() < 2) throw InputError(fmt::format("{}: route \"{}\" has no length", place, name));
  orient(direction, place);
  length_m_ = polyline_length_m(points_);
}

void RouteLine::orient(RouteDirection direction, const std::string& place) {
  bool reverse = direction == RouteDirection::reverse;
  if (direction == RouteDirection::counterclockwise || direction == RouteDirection::clockwise) {
    if (!closed_)
      throw InputError(
          fmt::format("{}: route \"{}\" is not closed: its direction is forward or reverse", place, name_));
    reverse = (signed_area(points_) > 0) != (direction == RouteDirection::counterclockwise);
  }
  if (reverse) std::reverse(points_.begin(), points_.end());
}

PlanarPose RouteLine::at(double s_m, const std::string& place) const {
  if (!closed_ && s_m > length_m_)
    throw InputError(
        fmt::format("{}: {} m is beyond the end of route \"{}\" ({:.2f} m)", place, s_m, name_, length_m_));
  double rest_m = closed_ ? std::fmod(s_m, length_m_) : s_m;
  size_t i = 1;
  for (; i + 1 < points_.size(); ++i) {
    const double side_m = (points_[i] - points_[i - 1]).norm();
    if (rest_m < side_m) break;
    rest_m -= side_m;
  }
  const Vec2 along = (points_[i] - points_[i - 1]).normalized();
  return {points_[i - 1] + rest_m * along, std::atan2(along.y(), along.x())};
}

std::vector<Vec2> RouteLine::stretch(double start_s_m, double laps, const std::string& place) const {
  const double end_s_m = start_s_m + laps * length_m_;
  if (!closed_ && laps > 1)
    throw InputError(fmt::format("{}.laps: route \"{}\" is not closed: at most 1", place, name_));
  if (!closed_ && start_s_m >= length_m_)
    throw InputError(fmt::format("{}.start_s_m: route \"{}\" is {:.2f} m long", place, name_, length_m_));
  std::vector<Vec2> out{at(start_s_m, place).position_m};
  const double last_m = closed_ ? end_s_m : std::min(end_s_m, length_m_);
  double corner_s_m = 0;
  for (size_t i = 1; corner_s_m < last_m; i = i + 1 == points_.size() ? 1 : i + 1) {
    corner_s_m += (points_[i] - points_[i - 1]).norm();
    if (corner_s_m > start_s_m + kSamePoint_m && corner_s_m < last_m - kSamePoint_m)
      out.push_back(points_[i]);
    if (!closed_ && i + 1 == points_.size()) break;
  }
  out.push_back(at(std::min(last_m, closed_ ? last_m : length_m_), place).position_m);
  return out;
}

}  // namespace vsslam

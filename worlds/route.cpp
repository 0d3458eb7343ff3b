#include "worlds/route.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

// Points after a up to and including b. a may be one of the points: taken by value.
void walk(std::vector<Vec3>& points, const Vec3 a, const Vec3& b, double spacing_m) {
  if ((b - a).norm() < 1e-9) return;
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing_m - 1e-9)));
  for (int i = 1; i <= steps; ++i) points.push_back(a + (b - a) * (static_cast<double>(i) / steps));
}

// The rounded corner from `before` (exclusive) to the end of the arc.
void turn(std::vector<Vec3>& points, const Vec3& corner, const Vec3& in, const Vec3& out, double radius_m,
          double spacing_m) {
  const double angle = std::atan2(in.cross(out).z(), in.dot(out));
  if (std::abs(angle) < 1e-9) return;
  const double tangent_m = radius_m * std::tan(std::abs(angle) / 2);
  const Vec3 start = corner - in * tangent_m;
  const Vec3 left(-in.y(), in.x(), 0);
  const double side = angle > 0 ? 1 : -1;
  const int steps =
      std::max(4, static_cast<int>(std::ceil(radius_m * std::abs(angle) / std::min(spacing_m, 0.2))));
  for (int i = 1; i <= steps; ++i) {
    const double a = std::abs(angle) * i / steps;
    points.push_back(start + in * (radius_m * std::sin(a)) + left * (side * radius_m * (1 - std::cos(a))));
  }
}

// On to a corner and round it, by an arc that takes at most half of the sides before and after.
void round_corner(std::vector<Vec3>& points, const Vec3& before, const Vec3& corner, const Vec3& after,
                  double radius_m, double spacing_m) {
  const Vec3 in = corner - before, out = after - corner;
  const double angle = std::abs(std::atan2(in.cross(out).z(), in.dot(out)));
  const double room_m = 0.5 * std::min(in.norm(), out.norm());
  const double r = std::min(radius_m, room_m / std::max(std::tan(angle / 2), 1e-9));
  walk(points, points.back(), corner - in.normalized() * (r * std::tan(angle / 2)), spacing_m);
  turn(points, corner, in.normalized(), out.normalized(), r, spacing_m);
}

}  // namespace

Route rounded_loop(std::string name, const std::vector<Vec3>& corners_world, double radius_m,
                   double spacing_m) {
  const size_t n = corners_world.size();
  const auto corner = [&](size_t i) { return corners_world[i % n]; };
  const Vec3 start = 0.5 * (corner(n - 1) + corner(0));
  Route route{.name = std::move(name), .closed = true, .points_world = {start}};
  for (size_t i = 0; i < n; ++i)
    round_corner(route.points_world, corner(i + n - 1), corner(i), corner(i + 1), radius_m, spacing_m);
  walk(route.points_world, route.points_world.back(), start, spacing_m);
  route.points_world.pop_back();  // closed: the start is not repeated
  return route;
}

Route rounded_path(std::string name, const std::vector<Vec3>& corners_world, double radius_m,
                   double spacing_m) {
  Route route{.name = std::move(name), .closed = false, .points_world = {corners_world.front()}};
  for (size_t i = 1; i + 1 < corners_world.size(); ++i)
    round_corner(route.points_world, corners_world[i - 1], corners_world[i], corners_world[i + 1], radius_m,
                 spacing_m);
  walk(route.points_world, route.points_world.back(), corners_world.back(), spacing_m);
  return route;
}

Route straight_route(std::string name, const Vec3& a_world, const Vec3& b_world, double spacing_m) {
  Route route{.name = std::move(name), .closed = false, .points_world = {a_world}};
  walk(route.points_world, a_world, b_world, spacing_m);
  return route;
}

Route reversed(const Route& route, std::string name) {
  Route back = route;
  back.name = std::move(name);
  const auto first = back.points_world.begin() + (route.closed && !back.points_world.empty() ? 1 : 0);
  std::reverse(first, back.points_world.end());
  return back;
}

double route_length_m(const Route& route) {
  double length_m = 0;
  const auto& p = route.points_world;
  for (size_t i = 1; i < p.size(); ++i) length_m += (p[i] - p[i - 1]).norm();
  if (route.closed && p.size() > 1) length_m += (p.front() - p.back()).norm();
  return length_m;
}

}  // namespace vsslam

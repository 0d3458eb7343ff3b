#include "sim/path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsslam {

namespace {

constexpr double kSmoothing_m = 0.15;  // sigma of the Gaussian that rounds corners
constexpr double kLateralAccel_mps2 = 1.0;
constexpr double kSlowest_mps = 0.05;

// Element i of a sequence that continues beyond its ends by point reflection: ends and straights stay in place.
Vec2 reflected(const std::vector<Vec2>& points, int i) {
  const int last = static_cast<int>(points.size()) - 1;
  const auto inside = [&](int k) { return points[static_cast<size_t>(std::clamp(k, 0, last))]; };
  if (i < 0) return 2 * inside(0) - inside(-i);
  if (i > last) return 2 * inside(last) - inside(2 * last - i);
  return inside(i);
}

std::vector<Vec2> smooth(const std::vector<Vec2>& points, double sigma_m) {
  const double sigma = sigma_m / Path::kSpacing_m;
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  std::vector<Vec2> out;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    Vec2 sum = Vec2::Zero();
    double weights = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double weight = std::exp(-0.5 * k * k / (sigma * sigma));
      sum += weight * reflected(points, i + k);
      weights += weight;
    }
    out.push_back(sum / weights);
  }
  return out;
}

Vec2 left_normal(const std::vector<Vec2>& points, int i) {
  const Vec2 along = reflected(points, i + 1) - reflected(points, i - 1);
  const double length = along.norm();
  return length > 0 ? Vec2(-along.y() / length, along.x() / length) : Vec2(0, 0);
}

}  // namespace

PlanarPose planar(const SE3& T_world_base) {
  const Vec3 forward_world = T_world_base.rotation * Vec3::UnitX();
  return {T_world_base.translation.head<2>(), std::atan2(forward_world.y(), forward_world.x())};
}

double wrap_angle(double rad) {
  return std::remainder(rad, 2 * M_PI);
}

double polyline_length_m(const std::vector<Vec2>& corners) {
  double length_m = 0;
  for (size_t i = 1; i < corners.size(); ++i) length_m += (corners[i] - corners[i - 1]).norm();
  return length_m;
}

std::vector<Vec2> resample(const std::vector<Vec2>& corners) {
  const double length_m = polyline_length_m(corners);
  const size_t pieces = std::max<size_t>(1, static_cast<size_t>(std::lround(length_m / Path::kSpacing_m)));
  std::vector<Vec2> out{corners.front()};
  double before_m = 0;  // arc length of corners[i - 1]
  size_t i = 1;
  for (size_t k = 1; k < pieces; ++k) {
    const double s_m = length_m * static_cast<double>(k) / static_cast<double>(pieces);
    while (i + 1 < corners.size() && before_m + (corners[i] - corners[i - 1]).norm() < s_m) {
      before_m += (corners[i] - corners[i - 1]).norm();
      ++i;
    }
    const Vec2 side = corners[i] - corners[i - 1];
    out.push_back(corners[i - 1] + side * ((s_m - before_m) / side.norm()));
  }
  out.push_back(corners.back());
  return out;
}

Path::Path(const std::vector<Vec2>& samples, const std::vector<double>& offset_left_m,
           const SpeedLimits& limits) {
  const std::vector<Vec2> centre = smooth(samples, kSmoothing_m);
  std::vector<Vec2> shifted;
  for (size_t i = 0; i < centre.size(); ++i)
    shifted.push_back(centre[i] + offset_left_m[i] * left_normal(centre, static_cast<int>(i)));
  const double length_m = polyline_length_m(shifted);
  for (const Vec2& position_m : resample(shifted)) places_.push_back({.position_m = position_m});
  spacing_m_ = length_m / static_cast<double>(places_.size() - 1);
  measure_directions();
  limit_speed(limits);
}

void Path::measure_directions() {
  std::vector<Vec2> points;
  for (const Place& place : places_) points.push_back(place.position_m);
  const int size = static_cast<int>(points.size());
  const auto place = [&](int i) -> Place& { return places_[static_cast<size_t>(i)]; };
  for (int i = 0; i < size; ++i) {
    const Vec2 along = reflected(points, i + 1) - reflected(points, i - 1);
    const double heading_rad = std::atan2(along.y(), along.x());
    const double before_rad = i > 0 ? place(i - 1).heading_rad : heading_rad;
    place(i).heading_rad = before_rad + wrap_angle(heading_rad - before_rad);
  }
  for (int i = 0; i < size; ++i) {
    const int low = std::max(0, i - 2), high = std::min(size - 1, i + 2);
    place(i).curvature_radpm =
        (place(high).heading_rad - place(low).heading_rad) / (spacing_m_ * (high - low));
  }
}

// v <= speed, |kappa| v <= yaw rate, kappa v^2 <= lateral acceleration, v v' <= acceleration; rest at both ends.
void Path::limit_speed(const SpeedLimits& limits) {
  for (Place& place : places_) {
    const double bend = std::max(std::abs(place.curvature_radpm), 1e-9);
    place.speed_mps =
        std::min({limits.speed_mps, limits.yaw_rate_radps / bend, std::sqrt(kLateralAccel_mps2 / bend)});
  }
  const auto reachable = [&](double from_mps) {
    return std::sqrt(from_mps * from_mps + 2 * limits.accel_mps2 * spacing_m_);
  };
  places_.front().speed_mps = places_.back().speed_mps = 0;
  for (size_t i = 1; i < places_.size(); ++i)
    places_[i].speed_mps = std::min(places_[i].speed_mps, reachable(places_[i - 1].speed_mps));
  for (size_t i = places_.size() - 1; i > 0; --i)
    places_[i - 1].speed_mps = std::min(places_[i - 1].speed_mps, reachable(places_[i].speed_mps));
}

Path::Place Path::at(double s_m) const {
  const double index = std::clamp(s_m / spacing_m_, 0.0, static_cast<double>(places_.size() - 1));
  const size_t i = std::min(static_cast<size_t>(index), places_.size() - 2);
  const double u = index - static_cast<double>(i);
  const Place &a = places_[i], &b = places_[i + 1];
  return {.position_m = a.position_m + u * (b.position_m - a.position_m),
          .heading_rad = a.heading_rad + u * (b.heading_rad - a.heading_rad),
          .curvature_radpm = a.curvature_radpm + u * (b.curvature_radpm - a.curvature_radpm),
          .speed_mps = a.speed_mps + u * (b.speed_mps - a.speed_mps)};
}

double Path::nearest(const Vec2& position_m, double from_m, double to_m) const {
  const auto index_at = [&](double s_m) {
    return static_cast<size_t>(std::clamp(s_m / spacing_m_, 0.0, static_cast<double>(places_.size() - 2)));
  };
  double best_s_m = from_m, best_distance_m = std::numeric_limits<double>::infinity();
  for (size_t i = index_at(from_m); i <= index_at(to_m); ++i) {
    const Vec2 a = places_[i].position_m, side = places_[i + 1].position_m - a;
    const double u = std::clamp(side.dot(position_m - a) / std::max(side.squaredNorm(), 1e-12), 0.0, 1.0);
    const double distance_m = (a + u * side - position_m).norm();
    if (distance_m < best_distance_m) {
      best_distance_m = distance_m;
      best_s_m = spacing_m_ * (static_cast<double>(i) + u);
    }
  }
  return std::clamp(best_s_m, from_m, std::max(from_m, to_m));
}

double Path::duration_s() const {
  double duration_s = 0;
  for (size_t i = 1; i < places_.size(); ++i) {
    const double mean_mps = 0.5 * (places_[i].speed_mps + places_[i - 1].speed_mps);
    duration_s += spacing_m_ / std::max(mean_mps, kSlowest_mps);
  }
  return duration_s;
}

}  // namespace vsslam

#include "scenarios/experiment/scan_disturbances.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sensors/lidar/laser_table.h"

namespace vsslam {

namespace {

constexpr double kSecondReturnDelay_s = 3e-6;
constexpr double kSecondReturnNearest_m = 0.5, kSecondReturnFurthest_m = 5;
constexpr float kSecondReturnIntensity = 0.5f;  // of the first's
constexpr float kDropIntensity = 2;             // of the reflectivity byte

double range_m(const LidarPoint& point) {
  return std::sqrt(double{point.x} * point.x + double{point.y} * point.y + double{point.z} * point.z);
}

/// Along its beam, which is taken to start at the origin.
void move_to(double new_range_m, LidarPoint& point) {
  const auto factor = static_cast<float>(new_range_m / range_m(point));
  point.x *= factor, point.y *= factor, point.z *= factor;
}

}  // namespace

/// What random numbers of a point depend on, whatever else becomes of the scan: when it was fired and by which laser.
struct ScanDisturber::Firing {
  Time scan;
  uint64_t index;
  bool happens(const RandomStream& stream, double share) const {
    return share > 0 && stream.uniform(scan, 2 * index) < share;
  }
  double uniform(const RandomStream& stream) const { return stream.uniform(scan, 2 * index + 1); }
  double normal(const RandomStream& stream) const { return stream.normal(scan, 2 * index + 1); }
};

void ScanDisturbances::Mast::fields(Fields& f) {
  f("radius_m", radius_m, between(0, 0.25));
  f("distance_m", distance_m, between(0.3, 1.5));
  f("azimuth_deg", azimuth_deg, between(-360, 360));
  f.check(radius_m < distance_m, "radius_m", "less than distance_m");
}

void ScanDisturbances::fields(Fields& f) {
  f("time_jitter_us", time_jitter_us, between(0, 10000));
  f("second_return_share", second_return_share, between(0, 1));
  f("rain_share", rain_share, between(0, 1));
  f("mast", mast);
  f.choice("rings", rings,
           {{"sensor", Rings::sensor},
            {"none", Rings::none},
            {"elevation", Rings::elevation},
            {"dropped", Rings::dropped}});
}

ScanDisturber::ScanDisturber(const ScanDisturbances& disturbances, const LidarConfig& lidar, uint64_t seed)
    : disturbances_(disturbances),
      min_range_m_(lidar.min_range_m),
      max_range_m_(lidar.max_range_m),
      range_sigma_m_(lidar.range_sigma_m),
      jitter_(seed, "handed.time_jitter"),
      second_(seed, "handed.second_return"),
      mast_(seed, "handed.mast"),
      rain_(seed, "handed.rain") {
  const std::vector<Laser>& lasers = laser_table(lidar.model).lasers;
  const auto [lowest, highest] =
      std::minmax_element(lasers.begin(), lasers.end(),
                          [](const Laser& a, const Laser& b) { return a.elevation_rad < b.elevation_rad; });
  lowest_rad_ = lowest->elevation_rad;
  highest_rad_ = highest->elevation_rad;
  rings_ = static_cast<int>(lasers.size());
}

bool ScanDisturber::any() const {
  const ScanDisturbances& d = disturbances_;
  return d.time_jitter_us > 0 || d.second_return_share > 0 || d.rain_share > 0 || d.mast.radius_m > 0 ||
         d.rings != ScanDisturbances::Rings::sensor;
}

void ScanDisturber::disturb(LidarMeasurement& measurement) const {
  if (!any()) return;
  const std::vector<LidarPoint> measured = std::exchange(measurement.scan.points, {});
  const std::vector<PointTruth> truth = std::exchange(measurement.truth, {});
  const auto last_time_s = static_cast<float>(seconds_between(measurement.scan.stamp, measurement.scan.end));
  const auto hand = [&](const Firing& firing, LidarPoint point) {
    label(firing, last_time_s, point);
    measurement.scan.points.push_back(point);
  };
  for (size_t i = 0; i < measured.size(); ++i) {
    LidarPoint point = measured[i], second;
    if (disturbances_.rings == ScanDisturbances::Rings::dropped && point.ring % 2 == 1) continue;
    const auto fired_ns = static_cast<uint64_t>(std::llround(double{point.time_s} * 1e9));
    const Firing firing{measurement.true_stamp, fired_ns << 8 | point.ring};
    const bool of_the_world = !move_onto_mast(firing, point) && !move_into_rain(firing, point);
    hand(firing, point);
    if (of_the_world && !truth.empty()) measurement.truth.push_back(truth[i]);
    if (second_return(firing, point, second)) hand(firing, second);
  }
}

// A ray from the axis meets a circle at distance d, seen from above, at c - sqrt(r^2 - s^2), where c and s are d times
// the cosine and sine of the angle between them.
bool ScanDisturber::move_onto_mast(const Firing& firing, LidarPoint& point) const {
  const ScanDisturbances::Mast& mast = disturbances_.mast;
  const double angle =
      std::atan2(double{point.y}, double{point.x}) - mast.azimuth_deg * std::numbers::pi / 180;
  const double c = mast.distance_m * std::cos(angle), s = mast.distance_m * std::sin(angle);
  if (c <= 0 || std::abs(s) >= mast.radius_m) return false;
  const double there_m = c - std::sqrt(mast.radius_m * mast.radius_m - s * s);
  const double horizontal_m = std::hypot(double{point.x}, double{point.y});
  if (there_m >= horizontal_m) return false;
  const double stretch = range_m(point) / horizontal_m;
  move_to(there_m * stretch + range_sigma_m_ * firing.normal(mast_), point);
  return true;
}

bool ScanDisturber::move_into_rain(const Firing& firing, LidarPoint& point) const {
  const double surface_m = range_m(point);
  if (surface_m <= min_range_m_ || !firing.happens(rain_, disturbances_.rain_share)) return false;
  move_to(min_range_m_ + (surface_m - min_range_m_) * firing.uniform(rain_), point);
  point.intensity = kDropIntensity;
  return true;
}

bool ScanDisturber::second_return(const Firing& firing, const LidarPoint& first, LidarPoint& second) const {
  if (!firing.happens(second_, disturbances_.second_return_share)) return false;
  second = first;
  const double gap_m =
      kSecondReturnNearest_m + (kSecondReturnFurthest_m - kSecondReturnNearest_m) * firing.uniform(second_);
  move_to(std::min(range_m(first) + gap_m, max_range_m_), second);
  second.intensity *= kSecondReturnIntensity;
  second.time_s += static_cast<float>(kSecondReturnDelay_s);
  return true;
}

// Ring and time are what the recorder writes of a firing: both returns get the same error. No time is outside the scan.
void ScanDisturber::label(const Firing& firing, float last_time_s, LidarPoint& point) const {
  if (disturbances_.time_jitter_us > 0) {
    const double jitter_s = 1e-6 * disturbances_.time_jitter_us * (2 * firing.uniform(jitter_) - 1);
    point.time_s += static_cast<float>(jitter_s);
  }
  point.time_s = std::clamp(point.time_s, 0.0f, last_time_s);
  if (disturbances_.rings == ScanDisturbances::Rings::none) point.ring = 0;
  if (disturbances_.rings == ScanDisturbances::Rings::elevation) {
    const double elevation_rad = std::atan2(double{point.z}, std::hypot(double{point.x}, double{point.y}));
    const double place = (elevation_rad - lowest_rad_) / (highest_rad_ - lowest_rad_) * (rings_ - 1);
    point.ring = static_cast<uint16_t>(std::clamp(std::lround(place), 0l, rings_ - 1l));
  }
}

}  // namespace vsslam

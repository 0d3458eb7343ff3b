// What becomes of a scan between a real sensor and an estimator: times that are not exact, second returns, rings that
// the driver does not give, and points that are not of the world.
#pragma once

#include "core/config.h"
#include "core/rng.h"
#include "sensors/lidar/lidar_config.h"
#include "sensors/measurement/samples.h"

namespace vsslam {

/// Each has random numbers of its own, by a point's true instant of firing and its laser. Defaults disturb nothing.
struct ScanDisturbances {
  /// What of a point's laser is known. sensor: its ring. none: nothing, 0 in all points. elevation: what the elevation
  /// rounds to if rings are taken for evenly spread. dropped: its ring, but every other ring (1, 3, ...) has no points.
  enum class Rings { sensor, none, elevation, dropped };

  /// An upright post on the robot, in the lidar frame; azimuth counter-clockwise from forward. Beams of any elevation end
  /// on it, and what is behind it is hidden.
  struct Mast {
    double radius_m = 0;  ///< 0: no mast
    double distance_m = 1, azimuth_deg = 180;
    void fields(Fields& f);
  };

  double time_jitter_us = 0;       ///< uniform, +-, of time_s; the points stay in order of firing
  double second_return_share = 0;  ///< of the points; 3 us later, 0.5 - 5 m further along the beam
  double rain_share = 0;           ///< of the points; a drop between the shortest range and the surface
  Mast mast{};
  Rings rings = Rings::sensor;
  void fields(Fields& f);
};

/// Disturbs the scans of one LiDAR. The same for any order of scans.
class ScanDisturber {
 public:
  ScanDisturber(const ScanDisturbances& disturbances, const LidarConfig& lidar, uint64_t seed);
  /// Afterwards `truth` is that of the points that still show the world, in their order; others have none.
  void disturb(LidarMeasurement& measurement) const;

 private:
  struct Firing;
  bool any() const;
  bool move_onto_mast(const Firing& firing, LidarPoint& point) const;
  bool move_into_rain(const Firing& firing, LidarPoint& point) const;
  bool second_return(const Firing& firing, const LidarPoint& first, LidarPoint& second) const;
  void label(const Firing& firing, float last_time_s, LidarPoint& point) const;

  ScanDisturbances disturbances_;
  double min_range_m_, max_range_m_, range_sigma_m_;
  double lowest_rad_, highest_rad_;  // elevations of the lasers
  int rings_;
  RandomStream jitter_, second_, mast_, rain_;
};

}  // namespace vsslam

// A scan sorted by ring and, within a ring, by firing: neighbours in the pattern of the sensor.
#pragma once

#include <cstdint>
#include <vector>

#include "core/samples.h"
#include "slam/lidar/cloud.h"

namespace vsslam {

/// Prefix sums make counts over a window O(1).
///
/// The order of firing is that of the points' times; where those say nothing (all equal) or are noisier than the time
/// between two firings, it is that of the azimuth. Of several returns of one firing the first stays.
struct RingOrder {
  std::vector<uint32_t> begin;  ///< of each ring, and the end of the last
  std::vector<uint32_t> index;  ///< into scan.points
  std::vector<uint16_t> ring;   ///< of each point, like all below
  std::vector<float> range_m;
  std::vector<float> firing;    ///< number of the firing since the ring's start, in steps of the usual one
  Cloud points_lidar;           ///< sorted
  std::vector<uint32_t> steps;  ///< number of range steps before i
  std::vector<uint8_t> shadowed;
  float step_rad = 0;           ///< between two firings of a laser

  /// `undistorted_lidar` are scan.points, same order. A range step is more than `jump_m` from point to point.
  RingOrder(const LidarScan& scan, const Cloud& undistorted_lidar, double jump_m);

  size_t rings() const { return begin.size() - 1; }

 private:
  void sort_by_ring(const LidarScan& scan);
  void sort_by_azimuth(const LidarScan& scan);
  void drop_repeated_firings();
  void measure_step();
  void fill(const LidarScan& scan, const Cloud& undistorted_lidar, float jump_m);
};

/// How far ranges scatter about the surface, m: from the third difference of neighbours in a ring, which no smooth
/// surface shows, as the median over all windows without a range step, so that edges and leaves do not count. 0 if
/// there are too few.
double measured_range_sigma_m(const RingOrder& order);

}  // namespace vsslam

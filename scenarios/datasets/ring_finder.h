// The ring of a point from its elevation, for clouds that do not say it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/samples.h"

namespace vsslam {

/// Elevations of a known LiDAR (VLP-16, VLP-32C) if nearly all points of the first cloud lie on them, else rings spread
/// evenly between the lowest and the highest point of the first cloud.
class RingFinder {
 public:
  explicit RingFinder(int rings) : rings_(rings) {}
  /// Fills `ring`; 0 is the lowest.
  void fill(std::vector<LidarPoint>& points);

 private:
  void learn(const std::vector<LidarPoint>& points);

  int rings_;
  std::vector<double> elevations_rad_;  // ascending, one per ring; empty: nothing learnt yet
};

}  // namespace vsslam

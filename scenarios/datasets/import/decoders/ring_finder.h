// Which ring a point is of: what its cloud says, if that makes sense, or else what its elevation says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/samples.h"

namespace vsslam {

/// What is wrong with the rings of a cloud, one for each point as the cloud has them; nullopt: they tell. They say nothing
/// if all are the same though elevations are not, or if more than 1 % are no whole number of 0 .. rings - 1.
std::optional<std::string> fault_of_rings(const std::vector<LidarPoint>& points,
                                          const std::vector<double>& rings, int most_rings);

/// Elevations of a known LiDAR (VLP-16, VLP-32C) if nearly all points of the first cloud lie on them; else those about
/// which its points gather, if they do so cleanly, for up to 128 lasers; else rings spread evenly between the lowest and
/// the highest point of the first cloud.
class RingFinder {
 public:
  explicit RingFinder(int rings) : rings_(rings) {}
  /// Fills `ring`; 0 is the lowest. False if the rings are only spread evenly: then they say nothing of the lasers.
  bool fill(std::vector<LidarPoint>& points);

 private:
  void learn(const std::vector<LidarPoint>& points);

  int rings_;
  bool clean_ = true;
  std::vector<double> elevations_rad_;  // ascending, one per ring; empty: nothing learnt yet
};

}  // namespace vsslam

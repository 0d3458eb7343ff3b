// Rings of a scan that has none worth the name, from the elevations about which its points gather.
#pragma once

#include <vector>

#include "core/samples.h"

namespace vsslam {

/// Of a point as measured, before it is undistorted.
double elevation_rad(const LidarPoint& point);
/// To a degree, as those of one ring are.
bool at_one_elevation(const std::vector<LidarPoint>& points);
/// Whether the points are of several rings, or of one that is a ring.
bool rings_tell(const std::vector<LidarPoint>& points);
/// Index of the value next to it.
size_t nearest(const std::vector<double>& ascending, double value);
/// Elevations that gather in narrow bands with wide gaps between them: the bands' means, ascending, at most 128. Empty:
/// they do not.
std::vector<double> gathered(std::vector<double> elevations_rad);

/// Learns the elevations of the lasers from the first scan.
class RingBands {
 public:
  /// Fills `ring`; 0 is the lowest. False: the points do not gather, and their rings are as they were.
  bool fill(std::vector<LidarPoint>& points);
  size_t rings() const { return bands_rad_.size(); }

 private:
  bool learnt_ = false;
  std::vector<double> bands_rad_;
};

}  // namespace vsslam

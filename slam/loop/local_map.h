// Local maps that loops are verified against: the key scans around a match, in the match's base frame.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "slam/loop/icp.h"
#include "slam/map/key_scan.h"

namespace vsslam {

/// Features of a key scan in its base frame.
Cloud features_in_base(const KeyScan& key, const SE3& T_base_lidar);

/// Mean of the points in each cube of `voxel_m`, in order of first appearance.
Cloud voxel_means(const Cloud& cloud, double voxel_m);

/// Ids of the first `key_count` key scans around `center`: [first, last].
struct KeyRange {
  int first = 0, last = -1;
  bool operator==(const KeyRange&) const = default;
};
KeyRange keys_around(int center, int half_width, int key_count);

/// Builds local maps and keeps the latest ones with their trees while the poses in them stand.
class LocalMaps {
 public:
  LocalMaps(const LocalMapConfig& config, const SE3& T_base_lidar)
      : config_(config), T_base_lidar_(T_base_lidar) {}

  /// Key scans `center` +- half_width_scans in their own poses, in the base frame of `center`. Only those
  /// before `query`: a scan is no evidence of its own pose.
  std::shared_ptr<const IcpTarget> around(int center, int query, const std::vector<KeyScan>& keys);

 private:
  struct Kept {
    int center;
    KeyRange range;
    std::vector<SE3> T_map_base;  // of the range, when the map was built
    std::shared_ptr<const IcpTarget> target;
  };
  bool stands(const Kept& kept, const std::vector<KeyScan>& keys) const;
  Kept build(int center, const KeyRange& range, const std::vector<KeyScan>& keys) const;

  LocalMapConfig config_;
  SE3 T_base_lidar_;
  std::deque<Kept> kept_;  // oldest first
};

}  // namespace vsslam

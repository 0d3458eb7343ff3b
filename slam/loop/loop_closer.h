// Loop closing of the methods that are compared: candidates, verification, accepted edges. Every candidate
// leaves a record, accepted or not.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/config.h"
#include "core/stage_clock.h"
#include "slam/graph/pose_graph.h"
#include "slam/lidar/degeneracy.h"
#include "slam/loop/loop_config.h"
#include "slam/loop/memory_decision.h"
#include "slam/map/key_scan.h"

namespace vsslam {

/// One candidate. Poses relate base frames: T_match_query maps query-base coordinates to match-base.
struct LoopRecord {
  int query = -1, match = -1;  ///< key scan ids
  Time query_stamp, match_stamp;
  double descriptor_distance = -1;  ///< -1: the method uses none
  double runner_up_distance = -1;   ///< best distance to any other stored scan, -1: none
  int virtual_id = 0;               ///< 0: the scan itself, 1..8N: virtual positions
  Eigen::Vector2d virtual_offset_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;  ///< of the winning shift
  bool icp_run = false, icp_converged = false;
  int icp_iterations = 0;
  double fitness_m2 = -1;       ///< mean squared distance of ICP's inliers
  double inlier_ratio = 0;      ///< share of the query's points with a correspondence
  double overlap = 0;           ///< share of them with a point of the match's local map nearby
  SE3 T_match_query;            ///< ICP's result, or the guess if ICP did not run
  SE3 T_match_query_predicted;  ///< from the poses before this loop
  bool accepted = false;
  /// "accepted", "distance" (descriptors differ), "few_points", "not_converged", "fitness", "overlap",
  /// "gap" (too far from where odometry expects it).
  std::string why;
  std::optional<Degeneracy> planes;  ///< what the planes see of the pose, if the fit was refined to them
  double edge_variance = 0;          ///< rad^2 and m^2, of an accepted loop
  double cauchy_scale = 0;           ///< of the edge's robust kernel; 0: quadratic
};

/// The edge that an accepted record adds to the pose graph. A fit that was refined to planes measures as odometry's
/// registration does and gets the covariance of an odometry edge in the directions that the planes see; the others,
/// and a fit that was not refined, get `edge_variance`.
PoseEdge loop_edge(const LoopRecord& record, const PoseGraphConfig& graph);

/// What the descriptor database holds.
struct StoredDescriptor {
  int key = -1;      ///< key scan id
  size_t bytes = 0;  ///< descriptor and keys actually held
};

struct DatabaseSize {
  int count = 0;  ///< descriptors
  size_t index_bytes =
      0;  ///< a vector of `count` four-byte ids with doubling capacity: 24 + 4 * 2^ceil(log2 n)
  size_t descriptor_bytes = 0;  ///< descriptors and keys
  size_t database_bytes = 0;    ///< with the clouds that are kept for verifying their loops
};

class LoopCloser {
 public:
  LoopCloser(const LoopConfig& config, Method method, const LidarCalibration& lidar, StageClock* clock);
  ~LoopCloser();

  /// Looks at the newest key scan (keys.back()); returns the records of its candidates, in order. `now` is
  /// the stamp of the scan; methods that look periodically keep their own last time. Called once per key
  /// scan. keys[i].id is i. Afterwards points_lidar of the newest key scan is no longer needed.
  std::vector<LoopRecord> add(const std::vector<KeyScan>& keys, Time now);

  /// What selective memory decided about the newest key scan; absent where the method does not select.
  std::optional<MemoryDecision> decision() const;
  std::vector<StoredDescriptor> stored() const;
  DatabaseSize database_size(const std::vector<KeyScan>& keys) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

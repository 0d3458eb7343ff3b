// Truth of loops: which accepted edges are true, which places are seen again, which were missed.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/se3.h"
#include "sensors/measurement/samples.h"
#include "sensors/ray/raycaster.h"
#include "slam/lidar/cloud.h"
#include "slam/loop/loop_closer.h"

namespace vsslam {

/// What is kept of a key scan to judge loops.
struct KeyScanTruth {
  int key = 0;  ///< id of the key scan; its index in the list
  Time stamp;
  SE3 T_world_base, T_world_lidar;
  Cloud points_lidar;  ///< noise-free, undistorted, at most a few hundred
};

struct LoopTruthOptions {
  size_t max_points = 480;     ///< of a scan, for overlap: evenly spread over the firing order
  double seen_within_m = 0.2;  ///< a point is seen if the ray to it ends no further than this before it
  double max_range_m = 100.0;  ///< points further away are not seen
  double true_within_m = 0.5, true_within_deg = 5.0;  ///< of an accepted edge's relative pose
  double revisit_within_m = 4.0, revisit_overlap = 0.3;
  Duration revisit_after{30'000'000'000};
};

/// Keeps `max_points` of the noise-free points, the same choice each time.
KeyScanTruth key_scan_truth(int key, const LidarMeasurement& measurement, const SE3& T_world_base,
                            size_t max_points);

enum class LoopVerdict { accepted_true, accepted_false, accepted_unknown, rejected };
std::string_view verdict_name(LoopVerdict verdict);  ///< "true", "false", "", "rejected"

/// Truth of one LoopRecord, as far as there is any.
struct LoopJudgement {
  std::optional<double> error_m, error_deg;  ///< of T_match_query against the truth
  std::optional<double> overlap;             ///< true share of the query's points that the match's pose sees
  LoopVerdict verdict = LoopVerdict::rejected;
};

/// A key scan at a place where the robot was before.
struct Revisit {
  int key = -1;
  int of = -1;  ///< nearest older key scan that qualifies
  double overlap = 0;
  bool closed = false;  ///< a true edge was accepted within revisit_within_m
};

struct LoopScore {
  int candidates = 0, accepted = 0, true_loops = 0, false_loops = 0;
  std::vector<LoopJudgement> judgements;  ///< one per record, same order
  std::vector<Revisit> revisits;          ///< in order of key
  /// closed / revisits; absent without revisits.
  std::optional<double> recall() const;
  /// true / (true + false); absent without accepted edges.
  std::optional<double> precision() const;
};

/// The verdict on one candidate; without both poses an accepted one stays unknown.
LoopJudgement judge_loop(const LoopRecord& record, const std::optional<SE3>& T_world_query,
                         const std::optional<SE3>& T_world_match, const LoopTruthOptions& options = {});

/// Judges the candidates where nothing is known but the robot's true poses, by key scan, or not even those: no
/// overlap, no revisits.
LoopScore score_loops(std::span<const LoopRecord> records,
                      const std::function<std::optional<SE3>(int key)>& T_world_base);

/// Ray casts happen in the raycaster's present state (objects as the last commit left them). Glass does not
/// hide.
class LoopOracle {
 public:
  /// keys[i].key == i. Both references must outlive the oracle.
  LoopOracle(const World& world, const Raycaster& raycaster, std::vector<KeyScanTruth> keys,
             const LoopTruthOptions& options = {});

  /// Share of the points of `query` that are seen from the pose of `match`, 0..1.
  double overlap(int query, int match) const;
  /// Does the pose of `match` see anything of `query`? Cheaper than overlap: tries every fifth point, ends at the first
  /// that is seen.
  bool overlaps(int query, int match) const;
  const std::vector<Revisit>& revisits() const { return revisits_; }  ///< `closed` still open
  const std::vector<KeyScanTruth>& keys() const { return keys_; }

  LoopScore score(std::span<const LoopRecord> records) const;

 private:
  /// How many of up to 16 points are seen.
  size_t count_seen(const Vec3& from_world, std::span<const Vec3> points_world) const;
  bool sees(const Vec3& from_world, const Vec3& point_world) const;
  std::optional<Revisit> revisit(int key) const;
  LoopJudgement judge(const LoopRecord& record) const;
  /// A true edge from `query` closes the revisits near it.
  void close_near(int query, std::vector<Revisit>& revisits) const;

  const Raycaster& raycaster_;
  std::vector<KeyScanTruth> keys_;
  LoopTruthOptions options_;
  std::vector<bool> glass_;  // by material
  std::vector<Revisit> revisits_;
};

}  // namespace vsslam

// Trajectory error by the definitions of evo (Grupp, github.com/MichaelGrupp/evo): ATE = its APE of the
// translation part, RPE = its relative pose error over a path distance.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/se3.h"
#include "scenarios/evaluation/alignment.h"

namespace vsslam {

struct ScoreOptions {
  Alignment alignment = Alignment::se3;
  Duration max_time_difference{10'000'000};  ///< of stamps that belong together
  double rpe_delta_m = 10.0;                 ///< path distance of a pair
  bool rpe_all_pairs = false;  ///< false: consecutive pairs (evo's default); true: a pair from every pose
  double rpe_relative_tolerance = 0.1;  ///< of rpe_delta_m, for all pairs
  bool rpe_pairs_from_truth = false;    ///< path distance of the truth instead of the estimate's
};

/// Indices of poses whose stamps belong together.
struct StampPair {
  size_t estimate, truth;
};

/// An alignment by positions needs so many.
inline constexpr int kLeastPairs = 3;
/// With less of the estimate compared, the figures tell of something else.
inline constexpr double kLeastCoverage = 0.5;

struct TrajectoryScore {
  int pairs = 0;  ///< associated poses
  /// Share of the estimate's poses that are associated, or lie between associated ones at most a second apart: a truth
  /// with one pose a second covers an estimate with ten.
  double coverage = 0;
  double ate_rmse_m = 0, ate_mean_m = 0, ate_max_m = 0;
  /// RMSE over the pairs of the relative translation error, in percent of rpe_delta_m, and of the rotation
  /// angle. Absent if the path has no pair of that length.
  std::optional<double> rpe_10m_percent, rpe_10m_deg;
  int rpe_pairs = 0;
  /// Distance between the estimated and the true position of the last associated pose, each seen from its own
  /// first associated pose (in that pose's frame). Needs no alignment: for a robot that comes back to its
  /// start it is the error of the end-to-start displacement.
  double end_error_m = 0;
  double path_length_m = 0;  ///< of the truth, over associated poses
  Similarity alignment;      ///< T_world_map, and the scale if it was asked for
  SE3 T_truth_estimate;      ///< by align_poses, for maps: determined on straight paths too
  std::vector<StampPair> matches;
  std::vector<double> errors_m;  ///< per match, after alignment
};

/// evo's rule: each pose of the shorter trajectory takes the nearest stamp of the longer one (the truth
/// counts as the longer one only if it has more poses), if it is near enough. Both sorted by stamp.
std::vector<StampPair> associate(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                                 Duration max_difference);

/// Pairs of indices one `delta_m` of path apart, as evo's filter_pairs_by_path makes them.
std::vector<std::pair<size_t, size_t>> pairs_by_path(std::span<const Vec3> positions, double delta_m,
                                                     bool all_pairs, double tolerance_m);

/// estimate: T_map_base, truth: T_world_base, or any two trajectories of the same body. Throws InputError if
/// no stamps belong together; `names` are for the message.
TrajectoryScore score(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                      const ScoreOptions& options = {},
                      const std::pair<std::string, std::string>& names = {"the estimate", "the truth"});

/// Why the associated positions leave the alignment open, so that an error after it says less than it seems to: fewer
/// than three, or all on one line. Empty: they do not. Needed are estimate and truth as they were scored.
std::string why_alignment_open(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                               const TrajectoryScore& scored);

}  // namespace vsslam

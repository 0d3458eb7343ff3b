// The figures of one run: metrics.json. No clock times and no facts of the host, so that bytes repeat.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/experiment/expectations.h"
#include "scenarios/health/health.h"

namespace vsslam {

/// What a run can be compared with: nothing, the robot's trajectory, or everything about a simulated world.
enum class Truth { none, trajectory, world };

/// A figure that a run may not have (no loop accepted: no precision) is absent, null in the file. What the run's truth
/// cannot tell has no key in the file.
struct Metrics {
  std::string scenario, method;
  std::optional<uint64_t> seed;  ///< of a simulated run; a recording has no such key
  Truth truth = Truth::world;
  std::string failure;  ///< why the run ended early; empty (null in the file): it did not
  double duration_s = 0, path_length_m = 0;
  int64_t scans = 0, images = 0;
  std::optional<double> ate_rmse_m, ate_max_m, rpe_10m_percent, rpe_10m_deg, end_error_m;
  std::optional<double> odometry_nees;  ///< of the edges from key scan to key scan: 1 if they err as they claim
  std::optional<double> odometry_ate_rmse_m, vio_ate_rmse_m, map_error_mean_m;
  std::optional<double> coverage;  ///< share of the scans that have truth
  struct Descriptors {
    int64_t count = 0, index_bytes = 0, descriptor_bytes = 0, database_bytes = 0;
  } descriptors;
  struct Loops {
    int64_t candidates = 0, accepted = 0, true_loops = 0, false_loops = 0, revisits = 0;
    int64_t aliases =
        0;  ///< pairs of key scans that look alike but share nothing; the world's, not the method's
    std::optional<double> recall, precision;
  } loops;
  struct Degeneracy {
    std::optional<double> precision, recall, direction_error_deg_median;
  } degeneracy;
  int64_t restarts = 0;
  Health health;
  Duration stamp_offset;                        ///< added to stamps where they are written
  std::vector<ExpectationResult> expectations;  ///< sorted by metric

  /// The file's content.
  std::string json() const;
  /// A figure by its name, groups with a dot: "loops.false". A list counts as its length.
  std::optional<double> value(const std::string& metric) const;
  /// Fills `expectations`.
  void compare(const MetricBounds& bounds);
};

}  // namespace vsslam

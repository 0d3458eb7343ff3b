// Perceptual aliases: places that look alike to a descriptor but have nothing in common.
#pragma once

#include <span>
#include <vector>

#include "scenarios/oracles/loop_truth.h"
#include "slam/loop/scan_context.h"

namespace vsslam {

/// A pair of key scans, query later than match.
struct Alias {
  int query = -1, match = -1;
  double distance = 1.0;  ///< of the noise-free descriptors, the least over shifts
};

/// The descriptor that a scan would have without noise.
ScanContext true_descriptor(const LidarMeasurement& measurement, double mount_height_m,
                            const ScanContextConfig& config);

/// All pairs whose noise-free descriptors are nearer than `threshold` although the one's pose sees nothing of the
/// other's points. One descriptor per key scan of the oracle. In order of query, then match.
std::vector<Alias> find_aliases(const LoopOracle& oracle, std::span<const ScanContext> descriptors,
                                double threshold);

}  // namespace vsslam

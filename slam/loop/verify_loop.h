// Verification of a loop candidate: the query's features against the local map of the match.
#pragma once

#include "slam/loop/local_map.h"
#include "slam/loop/loop_closer.h"

namespace vsslam {

/// Runs ICP from record.T_match_query, the guess, and fills in the result, `accepted` and `why`.
void verify_loop(const std::vector<KeyScan>& keys, const SE3& T_base_lidar, const VerificationConfig& config,
                 LocalMaps& maps, LoopRecord& record);

}  // namespace vsslam

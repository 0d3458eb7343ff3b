// Selective memory (Song et al. 2025, section 4.2): which key scans are worth searching for, and which worth
// storing.
#pragma once

#include <span>
#include <vector>

#include "slam/lidar/information.h"
#include "slam/loop/descriptor_database.h"
#include "slam/loop/loop_config.h"
#include "slam/loop/memory_decision.h"

namespace vsslam {

/// `query` begins with the scan's own descriptor; `stored` are those that it must differ from to be novel.
MemoryDecision decide(const SelectiveMemoryConfig& config, const Information& information,
                      std::span<const QueryDescriptor> query, const std::vector<const ScanContext*>& stored);

}  // namespace vsslam

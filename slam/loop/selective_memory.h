// Selective memory (Song et al. 2025, section 4.2): which key scans are worth searching for, and which worth
// storing.
#pragma once

#include <optional>
#include <span>

#include "slam/lidar/information.h"
#include "slam/loop/descriptor_database.h"
#include "slam/loop/loop_config.h"
#include "slam/loop/memory_decision.h"

namespace vsslam {

class SelectiveMemory {
 public:
  explicit SelectiveMemory(const SelectiveMemoryConfig& config) : config_(config) {}

  /// Key scans in order; `query` begins with the scan's own descriptor. What is stored becomes the one that
  /// the next are compared with.
  MemoryDecision decide(const Information& information, std::span<const QueryDescriptor> query);

 private:
  bool distinct(const Information& information) const;
  bool novel(std::span<const QueryDescriptor> query) const;

  SelectiveMemoryConfig config_;
  std::optional<ScanContext> last_stored_;
};

}  // namespace vsslam

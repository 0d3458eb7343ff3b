// How a method proposes loops. Verification is the same for all; its settings are the method's.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "slam/loop/descriptor_database.h"
#include "slam/loop/loop_closer.h"
#include "slam/loop/memory_decision.h"

namespace vsslam {

class LoopDetector {
 public:
  virtual ~LoopDetector() = default;

  /// Learns of every key scan, in order; the newest is the last.
  virtual void remember(const std::vector<KeyScan>& /*keys*/) {}
  /// What became of the newest key scan, of a method that selects.
  virtual std::optional<MemoryDecision> decision() const { return std::nullopt; }
  /// The candidate for the newest key scan: ids, descriptors and the guess T_match_query. A candidate with
  /// `why` set is recorded but not verified.
  virtual std::optional<LoopRecord> detect(const std::vector<KeyScan>& keys) = 0;
  virtual double period_s() const = 0;
  virtual const VerificationConfig& verification() const = 0;
  /// Weight of the edge of an accepted loop.
  virtual void weigh(LoopRecord& record) const = 0;
  /// Null if the method has none.
  virtual const DescriptorDatabase* database() const { return nullptr; }
  /// Key scans whose neighbourhoods may become targets of verification.
  virtual std::vector<int> possible_matches(const std::vector<KeyScan>& keys) const = 0;
};

/// A record with ids, stamps and what the poses say.
LoopRecord loop_candidate(const KeyScan& query, const KeyScan& match);

/// T_match_query (base frames) that a descriptor match suggests.
SE3 guess_from_descriptor(double yaw_rad, const Eigen::Vector2d& virtual_offset_m, const SE3& T_base_lidar);

/// Null for a method without loops.
std::unique_ptr<LoopDetector> make_detector(const LoopConfig& config, Method method,
                                            const LidarCalibration& lidar, StageClock* clock);

}  // namespace vsslam

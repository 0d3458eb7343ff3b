// Loop candidates of VS-SLAM and of its ablations.
#pragma once

#include "slam/loop/descriptor_database.h"
#include "slam/loop/loop_detector.h"

namespace vsslam {

/// Scan Context with virtual descriptors on the query and a selected database.
class VsSlamDetector final : public LoopDetector {
 public:
  VsSlamDetector(const VsSlamLoopConfig& config, const LoopConfig& common, const LidarCalibration& lidar,
                 StageClock* clock);

  void remember(const std::vector<KeyScan>& keys) override;
  std::optional<MemoryDecision> decision() const override { return decision_; }
  std::optional<LoopRecord> detect(const std::vector<KeyScan>& keys) override;
  double period_s() const override { return config_.period_s; }
  const VerificationConfig& verification() const override { return config_.verification; }
  void weigh(LoopRecord& record) const override;
  const DescriptorDatabase* database() const override { return &database_; }
  std::vector<int> possible_matches(const std::vector<KeyScan>& keys) const override;

 private:
  std::vector<const ScanContext*> to_differ_from(const std::vector<KeyScan>& keys) const;
  bool within_reach(const KeyScan& query, const KeyScan& match) const;

  VsSlamLoopConfig config_;
  ScanContextConfig scan_context_;
  LidarCalibration lidar_;
  StageClock* clock_;
  DescriptorDatabase database_;
  std::vector<QueryDescriptor> query_;  // of the newest key scan
  std::optional<MemoryDecision> decision_;
};

}  // namespace vsslam

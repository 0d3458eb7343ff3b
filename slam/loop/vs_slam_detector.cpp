#include "slam/loop/vs_slam_detector.h"

#include "slam/loop/selective_memory.h"
#include "slam/loop/virtual_descriptors.h"

namespace vsslam {

VsSlamDetector::VsSlamDetector(const VsSlamLoopConfig& config, const LoopConfig& common,
                               const LidarCalibration& lidar, StageClock* clock)
    : config_(config),
      scan_context_(common.scan_context),
      lidar_(lidar),
      clock_(clock),
      database_(common.exhaustive_pairs) {}

void VsSlamDetector::remember(const std::vector<KeyScan>& keys) {
  const StageTimer timer(clock_, "loop_descriptor");
  const KeyScan& key = keys.back();
  query_ =
      describe_query(*key.points_lidar, lidar_.mount_height_m, scan_context_, config_.virtual_descriptors);
  decision_ = decide(config_.memory, key.information, query_, to_differ_from(keys));
  if (decision_->stored()) database_.add(key.id, key.stamp, query_.front().context);
}

// What is stored where a search from the newest key scan looks, made however recently: being like a descriptor further
// off would leave a scan to which no search leads. As published, the last one stored.
std::vector<const ScanContext*> VsSlamDetector::to_differ_from(const std::vector<KeyScan>& keys) const {
  const std::vector<DescriptorDatabase::Entry>& entries = database_.entries();
  const bool only_last = config_.memory.novel_to == SelectiveMemoryConfig::NovelTo::last;
  std::vector<const ScanContext*> stored;
  for (size_t i = 0; i < entries.size(); ++i) {
    const bool counts = only_last ? i + 1 == entries.size()
                                  : within_reach(keys.back(), keys[static_cast<size_t>(entries[i].key)]);
    if (counts) stored.push_back(&entries[i].context);
  }
  return stored;
}

// A similar scene is neither stored nor searched; a distinct one is searched whether it was stored or not.
std::optional<LoopRecord> VsSlamDetector::detect(const std::vector<KeyScan>& keys) {
  if (!decision_->distinct) return std::nullopt;
  const StageTimer timer(clock_, "loop_search");
  const KeyScan& query = keys.back();
  const size_t eligible =
      database_.count_until(query.id - config_.exclude_recent_scans,
                            query.stamp - Duration::from_seconds(config_.exclude_recent_s));
  const std::optional<DescriptorMatch> match =
      database_.find(query_, eligible, [&](const DescriptorDatabase::Entry& entry) {
        return within_reach(query, keys[static_cast<size_t>(entry.key)]);
      });
  if (!match) return std::nullopt;
  const QueryDescriptor& winner = query_[match->descriptor];
  LoopRecord record = loop_candidate(query, keys[static_cast<size_t>(database_.entries()[match->entry].key)]);
  record.descriptor_distance = match->best.distance;
  record.runner_up_distance = match->runner_up_distance.value_or(-1);
  record.virtual_id = winner.virtual_id;
  record.virtual_offset_m = winner.offset_m;
  record.yaw_rad = match->best.yaw_rad();
  record.T_match_query = guess_from_descriptor(record.yaw_rad, record.virtual_offset_m, lidar_.T_base_lidar);
  if (record.descriptor_distance >= config_.max_distance) record.why = "distance";
  return record;
}

// Whether the query may have been made near the match, for all that odometry can have drifted since.
bool VsSlamDetector::within_reach(const KeyScan& query, const KeyScan& match) const {
  if (config_.search_reach_m <= 0) return true;
  const double apart_m = (query.T_map_base.translation - match.T_map_base.translation).norm();
  return apart_m <= config_.search_reach_m + config_.verification.allowed_gap_m(query.way_m - match.way_m);
}

void VsSlamDetector::weigh(LoopRecord& record) const {
  record.edge_variance = config_.edge_variance;
  record.cauchy_scale = config_.cauchy_scale;
}

std::vector<int> VsSlamDetector::possible_matches(const std::vector<KeyScan>&) const {
  std::vector<int> ids;
  for (const DescriptorDatabase::Entry& entry : database_.entries()) ids.push_back(entry.key);
  return ids;
}

}  // namespace vsslam

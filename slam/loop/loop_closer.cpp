#include "slam/loop/loop_closer.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "slam/loop/loop_detector.h"
#include "slam/loop/verify_loop.h"

namespace vsslam {

PoseEdge loop_edge(const LoopRecord& record, const PoseGraphConfig& graph) {
  PoseEdge edge;
  edge.from = record.match;
  edge.to = record.query;
  edge.T_from_to = record.T_match_query;
  edge.information = record.planes
                         ? record.planes->information(graph.loop_variances(), record.edge_variance)
                         : Mat6::Identity() / record.edge_variance;
  edge.is_loop = true;
  edge.cauchy_scale = record.cauchy_scale;
  return edge;
}

struct LoopCloser::Impl {
  Impl(const LoopConfig& loop_config, Method method, const LidarCalibration& lidar_calibration,
       StageClock* stages)
      : config(loop_config),
        T_base_lidar(lidar_calibration.T_base_lidar),
        clock(stages),
        detector(make_detector(loop_config, method, lidar_calibration, stages)),
        maps(loop_config.local_map, T_base_lidar) {}

  /// Whether the method looks at the key scan of this moment.
  bool due(Time now) {
    if (last_look && seconds_between(*last_look, now) < detector->period_s()) return false;
    last_look = now;
    return true;
  }

  LoopConfig config;
  SE3 T_base_lidar;
  StageClock* clock;
  std::unique_ptr<LoopDetector> detector;  // null: no loops
  LocalMaps maps;
  std::optional<Time> last_look;
};

LoopCloser::LoopCloser(const LoopConfig& config, Method method, const LidarCalibration& lidar,
                       StageClock* clock)
    : impl_(std::make_unique<Impl>(config, method, lidar, clock)) {}
LoopCloser::~LoopCloser() = default;

std::vector<LoopRecord> LoopCloser::add(const std::vector<KeyScan>& keys, Time now) {
  if (!impl_->detector) return {};
  LoopDetector& detector = *impl_->detector;
  detector.remember(keys);
  if (!impl_->due(now)) return {};
  std::optional<LoopRecord> record = detector.detect(keys);
  if (!record) return {};
  if (record->why.empty()) {
    const StageTimer timer(impl_->clock, "loop_icp");
    verify_loop(keys, impl_->T_base_lidar, detector.verification(), impl_->maps, *record);
  }
  if (record->accepted) detector.weigh(*record);
  return {*record};
}

std::optional<MemoryDecision> LoopCloser::decision() const {
  return impl_->detector ? impl_->detector->decision() : std::nullopt;
}

std::vector<StoredDescriptor> LoopCloser::stored() const {
  std::vector<StoredDescriptor> out;
  if (!impl_->detector || !impl_->detector->database()) return out;
  for (const DescriptorDatabase::Entry& entry : impl_->detector->database()->entries())
    out.push_back({entry.key, sizeof(entry.context)});
  return out;
}

DatabaseSize LoopCloser::database_size(const std::vector<KeyScan>& keys) const {
  DatabaseSize size;
  if (!impl_->detector) return size;
  if (impl_->detector->database()) {
    size.count = static_cast<int>(impl_->detector->database()->entries().size());
    const auto capacity = size.count > 0 ? std::bit_ceil(static_cast<size_t>(size.count)) : 0;
    size.index_bytes = 24 + 4 * capacity;
    size.descriptor_bytes = static_cast<size_t>(size.count) * sizeof(ScanContext);
  }
  const int key_count = static_cast<int>(keys.size());
  std::vector<bool> kept(keys.size(), false);
  for (int match : impl_->detector->possible_matches(keys)) {
    const KeyRange range = keys_around(match, impl_->config.local_map.half_width_scans, key_count);
    for (int id = range.first; id <= range.last; ++id) kept[static_cast<size_t>(id)] = true;
  }
  size.database_bytes = size.index_bytes + size.descriptor_bytes;
  for (size_t i = 0; i < keys.size(); ++i)
    if (kept[i]) size.database_bytes += keys[i].features_lidar->size() * sizeof(Eigen::Vector3f);
  return size;
}

}  // namespace vsslam

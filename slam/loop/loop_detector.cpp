#include "slam/loop/loop_detector.h"

#include <algorithm>
#include <limits>

#include "slam/loop/vs_slam_detector.h"

namespace vsslam {

namespace {

/// LVI-SAM: the nearest key pose that is old enough; ICP starts where odometry says.
class NearestKeyDetector final : public LoopDetector {
 public:
  explicit NearestKeyDetector(const LviSamLoopConfig& config) : config_(config) {}

  std::optional<LoopRecord> detect(const std::vector<KeyScan>& keys) override {
    const KeyScan& query = keys.back();
    const KeyScan* nearest = nullptr;
    double nearest_m = config_.search_radius_m;
    for (const KeyScan& key : keys) {
      if (seconds_between(key.stamp, query.stamp) <= config_.min_age_s) break;  // keys come in order of time
      const double distance_m = (key.T_map_base.translation - query.T_map_base.translation).norm();
      if (distance_m > nearest_m || (nearest && distance_m == nearest_m)) continue;
      nearest = &key;
      nearest_m = distance_m;
    }
    if (!nearest) return std::nullopt;
    return loop_candidate(query, *nearest);
  }
  double period_s() const override { return config_.period_s; }
  const VerificationConfig& verification() const override { return config_.verification; }
  void weigh(LoopRecord& record) const override {
    constexpr double kLeastVariance = 1e-6;  // a perfect fit is still a measurement
    record.edge_variance = std::max(record.fitness_m2, kLeastVariance);
  }
  std::vector<int> possible_matches(const std::vector<KeyScan>& keys) const override {
    std::vector<int> ids;
    for (const KeyScan& key : keys) ids.push_back(key.id);
    return ids;
  }

 private:
  LviSamLoopConfig config_;
};

/// SC-LVI-SAM: every key scan is stored, the most similar older one is the candidate.
class ScanContextDetector final : public LoopDetector {
 public:
  ScanContextDetector(const LoopConfig& config, const LidarCalibration& lidar, StageClock* clock)
      : config_(config.sc_lvi_sam),
        scan_context_(config.scan_context),
        lidar_(lidar),
        clock_(clock),
        database_(config.exhaustive_pairs) {}

  void remember(const std::vector<KeyScan>& keys) override {
    const KeyScan& key = keys.back();
    const StageTimer timer(clock_, "loop_descriptor");
    newest_ = QueryDescriptor{
        ScanContext(polar_heights(*key.points_lidar, lidar_.mount_height_m, scan_context_)), 0, {0, 0}};
    database_.add(key.id, key.stamp, newest_.context);
  }

  std::optional<LoopRecord> detect(const std::vector<KeyScan>& keys) override {
    const StageTimer timer(clock_, "loop_search");
    const KeyScan& query = keys.back();
    const size_t eligible = database_.count_until(query.id - config_.exclude_recent_scans, query.stamp);
    const std::optional<DescriptorMatch> match = database_.find({&newest_, 1}, eligible);
    if (!match) return std::nullopt;
    LoopRecord record =
        loop_candidate(query, keys[static_cast<size_t>(database_.entries()[match->entry].key)]);
    record.descriptor_distance = match->best.distance;
    record.runner_up_distance = match->runner_up_distance.value_or(-1);
    record.yaw_rad = match->best.yaw_rad();
    record.T_match_query = guess(record);
    if (record.descriptor_distance >= config_.max_distance) record.why = "distance";
    return record;
  }
  double period_s() const override { return config_.period_s; }
  const VerificationConfig& verification() const override {
    return as_published() ? config_.as_published : config_.repaired;
  }
  void weigh(LoopRecord& record) const override {
    record.edge_variance = config_.edge_variance;
    record.cauchy_scale = config_.cauchy_scale;
  }
  const DescriptorDatabase* database() const override { return &database_; }
  std::vector<int> possible_matches(const std::vector<KeyScan>&) const override {
    std::vector<int> ids;
    for (const DescriptorDatabase::Entry& entry : database_.entries()) ids.push_back(entry.key);
    return ids;
  }

 private:
  bool as_published() const { return config_.verification == ScLviSamLoopConfig::Verification::as_published; }

  SE3 guess(const LoopRecord& record) const {
    if (as_published()) return {};
    return guess_from_descriptor(record.yaw_rad, record.virtual_offset_m, lidar_.T_base_lidar);
  }

  ScLviSamLoopConfig config_;
  ScanContextConfig scan_context_;
  LidarCalibration lidar_;
  StageClock* clock_;
  DescriptorDatabase database_;
  QueryDescriptor newest_;
};

}  // namespace

LoopRecord loop_candidate(const KeyScan& query, const KeyScan& match) {
  LoopRecord record;
  record.query = query.id;
  record.match = match.id;
  record.query_stamp = query.stamp;
  record.match_stamp = match.stamp;
  record.T_match_query_predicted = match.T_map_base.inverse() * query.T_map_base;
  record.T_match_query = record.T_match_query_predicted;
  return record;
}

SE3 guess_from_descriptor(double yaw_rad, const Eigen::Vector2d& virtual_offset_m, const SE3& T_base_lidar) {
  // The query's sensor, moved to its virtual position, stands where the match's stood, turned by the yaw.
  const SE3 T_match_virtual = SE3::from_rpy({0, 0, yaw_rad}, Vec3::Zero());
  const SE3 T_virtual_query(Quat::Identity(), {-virtual_offset_m.x(), -virtual_offset_m.y(), 0});
  return T_base_lidar * T_match_virtual * T_virtual_query * T_base_lidar.inverse();
}

std::unique_ptr<LoopDetector> make_detector(const LoopConfig& config, Method method,
                                            const LidarCalibration& lidar, StageClock* clock) {
  switch (method) {
    case Method::lvi_sam_no_loop:
      return nullptr;
    case Method::lvi_sam:
      return std::make_unique<NearestKeyDetector>(config.lvi_sam);
    case Method::sc_lvi_sam:
      return std::make_unique<ScanContextDetector>(config, lidar, clock);
    case Method::vs_slam_no_vd:
    case Method::vs_slam_no_st:
    case Method::vs_slam:
      return std::make_unique<VsSlamDetector>(config.vs_slam.variant(method), config, lidar, clock);
  }
  return nullptr;
}

}  // namespace vsslam

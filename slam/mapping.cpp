#include "slam/mapping.h"

#include <utility>

#include "slam/map/map_cloud.h"

namespace vsslam {

struct Mapping::Impl {
  SlamConfig config;
  RigCalibration rig;
  StageClock* clock;
  LoopCloser loop_closer;
  PoseGraph graph;
  std::vector<KeyScan> keys;
  std::vector<LoopRecord> loops;
  std::vector<StampedPose> scans_odom_base;
  std::vector<int> key_of_scan;
  bool graph_changed = false;

  Impl(const SlamConfig& slam_config, const RigCalibration& rig_calibration, Method method,
       StageClock* stage_clock)
      : config(slam_config),
        rig(rig_calibration),
        clock(stage_clock),
        loop_closer(config.loop, method, rig.lidar, stage_clock) {}

  SE3 T_map_odom() const { return keys.back().T_map_base * keys.back().T_odom_base.inverse(); }
  void add_key(const OdometryScan& scan);
  void close_loops(Time now);
  void optimize();
};

// The back end, one scan.
ScanReport Mapping::add(const OdometryScan& scan) {
  Impl& impl = *impl_;
  const StageTimer whole(impl.clock, "mapping");
  ScanReport report = scan.report;
  if (scan.is_key) {
    report.key = static_cast<int>(impl.keys.size());
    // 1 the key scan enters the graph ...
    impl.add_key(scan);
    // 2 ... and looks for loops, which correct all key scans (1)
    impl.close_loops(scan.end);
    report.memory = impl.loop_closer.decision();
    impl.optimize();
  }
  // 3 the other scans move with their key scan
  impl.scans_odom_base.push_back({report.stamp, report.T_odom_base});
  impl.key_of_scan.push_back(static_cast<int>(impl.keys.size()) - 1);
  report.T_map_base = impl.T_map_odom() * report.T_odom_base;
  return report;
}

void Mapping::Impl::add_key(const OdometryScan& scan) {
  KeyScan key;
  key.id = static_cast<int>(keys.size());
  key.scan = scan.report.scan;
  key.stamp = scan.report.stamp;
  key.T_odom_base = scan.report.T_odom_base;
  key.T_map_base = keys.empty() ? key.T_odom_base : T_map_odom() * key.T_odom_base;
  key.features_lidar = scan.features_lidar;
  key.points_lidar = scan.points_lidar;
  key.map_points_lidar = scan.map_points_lidar;
  key.information = scan.report.information;
  graph.add_node(key.id, key.T_map_base);
  if (!keys.empty()) {
    const SE3 T_last_key = keys.back().T_odom_base.inverse() * key.T_odom_base;
    graph.add_edge({keys.back().id, key.id, T_last_key, config.graph.odometry_information(scan.covariance_since_key)});
    key.way_m = keys.back().way_m + T_last_key.translation.norm();
  }
  keys.push_back(std::move(key));
}

void Mapping::Impl::close_loops(Time now) {
  const StageTimer timer(clock, "loop");
  for (LoopRecord& record : loop_closer.add(keys, now)) {
    if (record.accepted) graph.add_edge(loop_edge(record, config.graph));
    graph_changed |= record.accepted;
    loops.push_back(std::move(record));
  }
  keys.back().points_lidar.reset();  // the whole scan was for its descriptor
}

void Mapping::Impl::optimize() {
  if (!graph_changed) return;
  const StageTimer timer(clock, "graph");
  graph.optimize(config.graph);
  for (KeyScan& key : keys) key.T_map_base = graph.pose(key.id);
  graph_changed = false;
}

Mapping::Mapping(const SlamConfig& config, const RigCalibration& rig, Method method, StageClock* clock)
    : impl_(std::make_unique<Impl>(config, rig, method, clock)) {}
Mapping::~Mapping() = default;

void Mapping::finish() {
  impl_->graph_changed = !impl_->loops.empty();
  impl_->optimize();
}

std::vector<StampedPose> Mapping::trajectory_map_base() const {
  std::vector<StampedPose> poses;
  for (size_t i = 0; i < impl_->scans_odom_base.size(); ++i) {
    const StampedPose& scan = impl_->scans_odom_base[i];
    const KeyScan& key = impl_->keys[static_cast<size_t>(impl_->key_of_scan[i])];
    poses.push_back({scan.stamp, key.T_map_base * (key.T_odom_base.inverse() * scan.pose)});
  }
  return poses;
}
const std::vector<StampedPose>& Mapping::trajectory_odom_base() const {
  return impl_->scans_odom_base;
}
const std::vector<KeyScan>& Mapping::key_scans() const {
  return impl_->keys;
}
const std::vector<LoopRecord>& Mapping::loops() const {
  return impl_->loops;
}
const LoopCloser& Mapping::loop_closer() const {
  return impl_->loop_closer;
}
const PoseGraph& Mapping::pose_graph() const {
  return impl_->graph;
}
Cloud Mapping::map_cloud(double voxel_m) const {
  return vsslam::map_cloud(impl_->keys, impl_->rig.lidar.T_base_lidar, voxel_m);
}

}  // namespace vsslam

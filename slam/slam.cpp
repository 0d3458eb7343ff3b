#include "slam/slam.h"

#include <utility>

#include "slam/inertial/imu_track.h"
#include "slam/inertial/rest_alignment.h"
#include "slam/lidar/undistort.h"
#include "slam/map/map_cloud.h"

namespace vsslam {

void SlamConfig::fields(Fields& f) {
  f.choice("prior", prior,
           {{"wheel_imu", PriorKind::wheel_imu},
            {"imu", PriorKind::imu},
            {"wheel", PriorKind::wheel},
            {"constant_velocity", PriorKind::constant_velocity}});
  f("inertial", inertial);
  f("odometry", odometry);
  f("loop", loop);
  f("graph", graph);
}

struct Slam::Impl {
  SlamConfig config;
  RigCalibration rig;
  StageClock* clock;
  std::unique_ptr<MotionPrior> prior;
  LidarOdometry odometry;
  LoopCloser loop_closer;
  PoseGraph graph;
  ImuTrack imu_before_start;
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
        prior(make_motion_prior(config.prior, config.inertial, rig)),
        odometry(config.odometry),
        loop_closer(config.loop, method, rig.lidar, stage_clock),
        imu_before_start(track_limits(config.inertial)) {}

  bool started() const { return !scans_odom_base.empty(); }
  SE3 start_pose();
  SE3 predicted_pose(Time stamp);
  MotionPath motion_during(const LidarScan& scan) const;
  void correct_prior(Time stamp, const SE3& T_odom_base, const Registration& registration);
  void add_key(const ScanReport& report, const std::vector<Feature>& features,
               const std::vector<Feature>& thin, Cloud points_lidar);
  void close_loops(Time now);
  void optimize();
  SE3 T_map_odom() const { return keys.back().T_map_base * keys.back().T_odom_base.inverse(); }
  ScanReport add(const LidarScan& scan);
};

// The whole method, one scan.
ScanReport Slam::Impl::add(const LidarScan& scan) {
  const StageTimer whole(clock, "scan");
  ScanReport report;
  report.stamp = scan.stamp;
  report.scan = static_cast<int64_t>(scans_odom_base.size());
  const auto timed = [&](const char* stage, auto&& step) {
    const StageTimer timer(clock, stage);
    return step();
  };
  // 1 prior: where the other sensors say the scan was taken, and how the robot moved during it
  const SE3 T_odom_base_prior = started() ? predicted_pose(scan.stamp) : start_pose();
  const MotionPath motion = motion_during(scan);
  // 2 undistort: all points to the scan's stamp
  Cloud points_lidar = timed("undistort", [&] { return undistort(scan, motion, rig.lidar.T_base_lidar); });
  // 3 features: planar points, thinned
  const LidarOdometryConfig& settings = config.odometry;
  const auto thin = timed("features", [&] {
    return select_thin_features(scan, points_lidar, rig.lidar.rings, settings.features, settings.voxel_m);
  });
  // 4 register: point to plane against the local map; blind directions keep the prior
  const Registration registration =
      timed("register", [&] { return odometry.align(thin, T_odom_base_prior * rig.lidar.T_base_lidar); });
  report.T_odom_base = registration.T_odom_lidar * rig.lidar.T_base_lidar.inverse();
  // 5 what the LiDAR has seen corrects the prior's biases and velocity
  correct_prior(scan.stamp, report.T_odom_base, registration);
  // 6 key scan? it enters the local map and the graph ...
  const bool is_key = odometry.wants_key(report.T_odom_base);
  report.information = registration.information;
  if (is_key) {
    report.key = static_cast<int>(keys.size());
    const auto dense = timed("features_of_key", [&] {
      return select_thin_features(scan, points_lidar, rig.lidar.rings, settings.features,
                                  settings.map_voxel_m);
    });
    timed("map", [&] { return add_key(report, dense, thin, std::move(points_lidar)); });
    // 7 ... and looks for loops, which correct all key scans
    close_loops(scan.end);
  }
  scans_odom_base.push_back({scan.stamp, report.T_odom_base});
  key_of_scan.push_back(static_cast<int>(keys.size()) - 1);
  report.T_map_base = T_map_odom() * report.T_odom_base;
  report.correspondences = registration.correspondences;
  report.iterations = registration.iterations;
  report.converged = registration.converged;
  report.degenerate_directions = registration.degeneracy.directions;
  report.used_prior_only = registration.used_prior_only;
  return report;
}

// Base at the origin, yaw 0, gravity along -z.
SE3 Slam::Impl::start_pose() {
  const RestAlignment rest = align_at_rest(imu_before_start.samples(), rig.imu, config.inertial);
  const InitialState state{SE3(rest.q_odom_base, Vec3::Zero()), rest.gyro_bias_radps,
                           rest.gyro_bias_sigma_radps, rest.at_rest};
  prior->start(state);
  imu_before_start.clear();
  return state.T_odom_base;
}

SE3 Slam::Impl::predicted_pose(Time stamp) {
  const StampedPose& last = scans_odom_base.back();
  return last.pose * prior->path(last.stamp, stamp).end_pose();
}

// The prior's state is still that of the last scan: its motion from there to the end, seen from this scan's
// stamp.
MotionPath Slam::Impl::motion_during(const LidarScan& scan) const {
  const Time from = started() ? scans_odom_base.back().stamp : scan.stamp;
  const MotionPath since_last = prior->path(from, scan.end);
  const SE3 T_begin_last = since_last.at(scan.stamp).inverse();
  MotionPath motion(scan.stamp);
  for (const StampedPose& knot : since_last.knots()) motion.append(knot.stamp, T_begin_last * knot.pose);
  return motion;
}

void Slam::Impl::correct_prior(Time stamp, const SE3& T_odom_base, const Registration& registration) {
  OdometryFix fix{stamp, T_odom_base, Mat3::Zero(), Mat3::Zero()};
  if (!registration.used_prior_only) {
    const Mat3 R_base_lidar = rig.lidar.T_base_lidar.matrix3();
    fix.observed_rotation =
        R_base_lidar * registration.degeneracy.observed_rotation() * R_base_lidar.transpose();
    fix.observed_translation =
        R_base_lidar * registration.degeneracy.observed_translation() * R_base_lidar.transpose();
  }
  prior->correct(fix);
}

void Slam::Impl::add_key(const ScanReport& report, const std::vector<Feature>& features,
                         const std::vector<Feature>& thin, Cloud points_lidar) {
  odometry.insert_key(features, report.T_odom_base, rig.lidar.T_base_lidar);
  KeyScan key;
  key.id = report.key;
  key.scan = report.scan;
  key.stamp = report.stamp;
  key.T_odom_base = report.T_odom_base;
  key.T_map_base = keys.empty() ? report.T_odom_base : T_map_odom() * report.T_odom_base;
  for (const Feature& feature : thin) key.features_lidar.push_back(feature.point_lidar);
  key.points_lidar = std::move(points_lidar);
  key.information = report.information;
  graph.add_node(key.id, key.T_map_base);
  if (!keys.empty()) {
    const SE3 T_last_key = keys.back().T_odom_base.inverse() * key.T_odom_base;
    graph.add_edge({keys.back().id, key.id, T_last_key, config.graph.odometry_information()});
  }
  keys.push_back(std::move(key));
}

void Slam::Impl::close_loops(Time now) {
  std::vector<LoopRecord> records;
  {
    const StageTimer timer(clock, "loop");
    records = loop_closer.add(keys, now);
  }
  for (LoopRecord& record : records) {
    if (record.accepted) graph.add_edge(loop_edge(record));
    graph_changed |= record.accepted;
    loops.push_back(std::move(record));
  }
  // The whole scan was for its descriptor; the map needs less.
  keys.back().points_lidar = thin_cloud(keys.back().points_lidar, 0.5 * config.odometry.voxel_m);
  optimize();
}

void Slam::Impl::optimize() {
  if (!graph_changed) return;
  const StageTimer timer(clock, "graph");
  graph.optimize(config.graph);
  for (KeyScan& key : keys) key.T_map_base = graph.pose(key.id);
  graph_changed = false;
}

Slam::Slam(const SlamConfig& config, const RigCalibration& rig, Method method, StageClock* clock)
    : impl_(std::make_unique<Impl>(config, rig, method, clock)) {}
Slam::~Slam() = default;

void Slam::add(const ImuSample& sample) {
  if (!impl_->started()) impl_->imu_before_start.add(sample);
  impl_->prior->add(sample);
}
void Slam::add(const WheelSample& sample) {
  impl_->prior->add(sample);
}
ScanReport Slam::add(const LidarScan& scan) {
  return impl_->add(scan);
}
void Slam::finish() {
  impl_->graph_changed = !impl_->loops.empty();
  impl_->optimize();
}

std::vector<StampedPose> Slam::trajectory_map_base() const {
  std::vector<StampedPose> poses;
  for (size_t i = 0; i < impl_->scans_odom_base.size(); ++i) {
    const StampedPose& scan = impl_->scans_odom_base[i];
    const KeyScan& key = impl_->keys[static_cast<size_t>(impl_->key_of_scan[i])];
    poses.push_back({scan.stamp, key.T_map_base * (key.T_odom_base.inverse() * scan.pose)});
  }
  return poses;
}
const std::vector<StampedPose>& Slam::trajectory_odom_base() const {
  return impl_->scans_odom_base;
}
const std::vector<KeyScan>& Slam::key_scans() const {
  return impl_->keys;
}
const std::vector<LoopRecord>& Slam::loops() const {
  return impl_->loops;
}
const LoopCloser& Slam::loop_closer() const {
  return impl_->loop_closer;
}
const PoseGraph& Slam::pose_graph() const {
  return impl_->graph;
}
Cloud Slam::map_cloud(double voxel_m) const {
  return vsslam::map_cloud(impl_->keys, impl_->rig.lidar.T_base_lidar, voxel_m);
}

}  // namespace vsslam

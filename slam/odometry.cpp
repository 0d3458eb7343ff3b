#include "slam/odometry.h"

#include <optional>
#include <utility>

#include "slam/inertial/imu_track.h"
#include "slam/inertial/rest_alignment.h"
#include "slam/lidar/undistort.h"
#include "slam/map/map_cloud.h"
#include "slam/vision/vio_prior.h"

namespace vsslam {

namespace {

std::unique_ptr<MotionPrior> make_prior(const SlamConfig& config, const RigCalibration& rig,
                                        StageClock* clock) {
  if (config.prior == PriorKind::vio)
    return std::make_unique<VioPrior>(config.vision, config.inertial, rig, clock);
  return make_motion_prior(config.prior, config.inertial, rig);
}

}  // namespace

struct Odometry::Impl {
  SlamConfig config;
  RigCalibration rig;
  StageClock* clock;
  std::unique_ptr<MotionPrior> prior;
  LidarOdometry lidar;
  ImuTrack imu_before_start;
  std::optional<StampedPose> last_odom_base;  // of the last scan
  OdometryHealth health;

  Impl(const SlamConfig& slam_config, const RigCalibration& rig_calibration, StageClock* stage_clock)
      : config(slam_config),
        rig(rig_calibration),
        clock(stage_clock),
        prior(make_prior(config, rig, clock)),
        lidar(config.odometry),
        imu_before_start(track_limits(config.inertial)) {}

  SE3 start_pose();
  SE3 predicted_pose(Time stamp) const;
  MotionPath motion_during(const LidarScan& scan) const;
  void correct_prior(Time stamp, const SE3& T_odom_base, const Registration& registration);
  std::vector<Feature> features(const char* stage, const LidarScan& scan, const Cloud& points_lidar,
                                double voxel_m) const;
  void make_key(const LidarScan& scan, const std::vector<Feature>& thin, Cloud points_lidar,
                OdometryScan& result);
  OdometryScan add(const LidarScan& scan);
};

// The front end, one scan.
OdometryScan Odometry::Impl::add(const LidarScan& scan) {
  const StageTimer whole(clock, "odometry");
  // 1 prior: where the other sensors say the scan was taken, and how the robot moved during it
  const SE3 T_odom_base_prior = last_odom_base ? predicted_pose(scan.stamp) : start_pose();
  const MotionPath motion = motion_during(scan);
  // 2 undistort: all points to the scan's stamp
  Cloud points_lidar;
  {
    const StageTimer timer(clock, "undistort");
    points_lidar = undistort(scan, motion, rig.lidar.T_base_lidar);
  }
  // 3 features: planar points, thinned
  const std::vector<Feature> thin = features("features", scan, points_lidar, config.odometry.voxel_m);
  // 4 register: point to plane against the local map; blind directions keep the prior
  Registration registration;
  {
    const StageTimer timer(clock, "register");
    registration = lidar.align(thin, T_odom_base_prior * rig.lidar.T_base_lidar);
  }
  const SE3 T_odom_base = registration.T_odom_lidar * rig.lidar.T_base_lidar.inverse();
  // 5 what the LiDAR has seen corrects the prior's biases and velocity
  correct_prior(scan.stamp, T_odom_base, registration);
  prior->add_scan(scan.stamp, points_lidar, T_odom_base);
  last_odom_base = StampedPose{scan.stamp, T_odom_base};

  OdometryScan result;
  result.end = scan.end;
  ScanReport& report = result.report;
  report.stamp = scan.stamp;
  report.scan = health.scans++;
  report.T_odom_base = T_odom_base;
  report.information = registration.information;
  report.correspondences = registration.correspondences;
  report.iterations = registration.iterations;
  report.converged = registration.converged;
  report.degenerate_directions = registration.degeneracy.directions;
  report.used_prior_only = registration.used_prior_only;
  if (report.used_prior_only) ++health.scans_prior_only;
  if (!report.converged) ++health.scans_unconverged;
  result.visual = prior->visual_report();
  // 6 far enough from the last key scan? then it enters the local map
  if (lidar.wants_key(T_odom_base)) make_key(scan, thin, std::move(points_lidar), result);
  return result;
}

// Base at the origin, yaw 0, gravity along -z.
SE3 Odometry::Impl::start_pose() {
  const RestAlignment rest = align_at_rest(imu_before_start.samples(), rig.imu, config.inertial);
  const InitialState state{SE3(rest.q_odom_base, Vec3::Zero()), rest.gyro_bias_radps,
                           rest.gyro_bias_sigma_radps, rest.at_rest, rest.accel_bias_mps2};
  prior->start(state);
  imu_before_start.clear();
  return state.T_odom_base;
}

SE3 Odometry::Impl::predicted_pose(Time stamp) const {
  return last_odom_base->pose * prior->path(last_odom_base->stamp, stamp).end_pose();
}

// The prior's state is still that of the last scan: its motion from there to the end, seen from this scan's
// stamp.
MotionPath Odometry::Impl::motion_during(const LidarScan& scan) const {
  const Time from = last_odom_base ? last_odom_base->stamp : scan.stamp;
  const MotionPath since_last = prior->path(from, scan.end);
  const SE3 T_begin_last = since_last.at(scan.stamp).inverse();
  MotionPath motion(scan.stamp);
  for (const StampedPose& knot : since_last.knots()) motion.append(knot.stamp, T_begin_last * knot.pose);
  return motion;
}

void Odometry::Impl::correct_prior(Time stamp, const SE3& T_odom_base, const Registration& registration) {
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

std::vector<Feature> Odometry::Impl::features(const char* stage, const LidarScan& scan,
                                              const Cloud& points_lidar, double voxel_m) const {
  const StageTimer timer(clock, stage);
  return select_thin_features(scan, points_lidar, rig.lidar.rings, config.odometry.features, voxel_m);
}

void Odometry::Impl::make_key(const LidarScan& scan, const std::vector<Feature>& thin, Cloud points_lidar,
                              OdometryScan& result) {
  const std::vector<Feature> dense =
      features("features_of_key", scan, points_lidar, config.odometry.map_voxel_m);
  const StageTimer timer(clock, "map");
  lidar.insert_key(dense, result.report.T_odom_base, rig.lidar.T_base_lidar);
  Cloud features_lidar;
  features_lidar.reserve(thin.size());
  for (const Feature& feature : thin) features_lidar.push_back(feature.point_lidar);
  result.is_key = true;
  result.features_lidar = share(std::move(features_lidar));
  result.map_points_lidar = share(thin_cloud(points_lidar, 0.5 * config.odometry.voxel_m));
  result.points_lidar = share(std::move(points_lidar));
}

Odometry::Odometry(const SlamConfig& config, const RigCalibration& rig, StageClock* clock)
    : impl_(std::make_unique<Impl>(config, rig, clock)) {}
Odometry::~Odometry() = default;

void Odometry::add(const ImuSample& sample) {
  if (!impl_->last_odom_base) impl_->imu_before_start.add(sample);
  impl_->prior->add(sample);
}
void Odometry::add(const WheelSample& sample) {
  impl_->prior->add(sample);
}
void Odometry::add(const CameraFrame& image) {
  impl_->prior->add(image);
}
OdometryScan Odometry::add(const LidarScan& scan) {
  return impl_->add(scan);
}
const OdometryHealth& Odometry::health() const {
  return impl_->health;
}

}  // namespace vsslam

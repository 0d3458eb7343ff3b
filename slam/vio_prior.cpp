#include "slam/vio_prior.h"

#include "slam/inertial/pose_covariance.h"
#include "slam/vio/vio_predict.h"

namespace vsslam {

void VisionConfig::fields(Fields& f) {
  f("tracker", tracker);
  f("depth", depth);
  f("vio", vio);
  f("lidar_depth", lidar_depth);
  f("lidar_aid", lidar_aid);
}

VioPrior::VioPrior(const VisionConfig& config, const InertialConfig& inertial, const RigCalibration& rig,
                   StageClock* clock)
    : config_(config),
      rig_(rig),
      clock_(clock),
      tracker_(config.tracker, rig.camera),
      depth_(config.depth, rig),
      vio_(config.vio, rig, track_limits(inertial), clock),
      fallback_(inertial, rig, true),
      imu_(track_limits(inertial)) {}

void VioPrior::start(const InitialState& state) {
  fallback_.start(state);
}

void VioPrior::add(const ImuSample& sample) {
  fallback_.add(sample);
  imu_.add(sample);
  vio_.add(sample);
}

// One image: track, and where the window wants it: look for new features, give depth, slide the window.
void VioPrior::add(const CameraFrame& image) {
  const StageTimer whole(clock_, "image");
  const Time stamp = image.stamp + Duration::from_seconds(config_.vio.time_offset_s);
  const bool wanted = vio_.wants(image.stamp);
  VisualFrame frame;
  {
    const StageTimer timer(clock_, "track");
    const std::optional<Quat> q_last_now = last_image_ ? camera_turn(*last_image_, stamp) : std::nullopt;
    frame = tracker_.track(image, q_last_now ? &*q_last_now : nullptr, wanted);
  }
  last_image_ = stamp;
  if (!wanted) return;
  if (config_.lidar_depth) fill_depth(stamp, frame);
  vio_.add(frame);
}

// Rotation of the camera between two images by the gyroscope: coordinates of the later frame into the earlier.
std::optional<Quat> VioPrior::camera_turn(Time from, Time to) const {
  const std::optional<ImuSpan> span = cut_span(imu_, from, to, kMaxImuGap_s);
  if (!span) return std::nullopt;
  const Quat q_from_to = preintegrate(*span, rig_.imu, fallback_.bias()).delta_R();
  const Quat q_imu_camera = (rig_.imu.T_base_imu.inverse() * rig_.camera.T_base_camera).rotation;
  return q_imu_camera.conjugate() * q_from_to * q_imu_camera;
}

void VioPrior::fill_depth(Time stamp, VisualFrame& frame) const {
  const std::optional<OdometryFix>& last = fallback_.fixes().last();
  if (!last || stamp < last->stamp) return;
  const StageTimer timer(clock_, "depth");
  const SE3 T_odom_base = last->T_odom_base * path(last->stamp, stamp).end_pose();
  depth_.fill(frame, T_odom_base * rig_.camera.T_base_camera);
}

std::optional<MotionPath> VioPrior::visual_path(Time begin, Time end) const {
  const std::vector<StampedPose> poses = vio_.path_vio_imu(begin, end);
  if (poses.empty()) return std::nullopt;
  const SE3& T_base_imu = rig_.imu.T_base_imu;
  const SE3 T_imu_base = T_base_imu.inverse();
  const SE3 T_begin_vio = T_base_imu * poses.front().pose.inverse();
  MotionPath path(begin);
  for (const StampedPose& pose : poses) path.append(pose.stamp, T_begin_vio * pose.pose * T_imu_base);
  return path;
}

MotionPath VioPrior::path(Time begin, Time end) const {
  if (begin < end)
    if (std::optional<MotionPath> visual = visual_path(begin, end)) return std::move(*visual);
  return fallback_.path(begin, end);
}

std::optional<MotionPath> VioPrior::visual_path_since_fix(Time end) const {
  const std::optional<OdometryFix>& last = fallback_.fixes().last();
  return last && last->stamp < end ? visual_path(last->stamp, end) : std::nullopt;
}

Mat6 VioPrior::covariance(Time end) const {
  const std::optional<MotionPath> visual = visual_path_since_fix(end);
  if (!visual) return fallback_.covariance(end);
  return moved_covariance(fallback_.fixes().last()->covariance, visual->end_pose()) + step_covariance(end);
}

// While it tracks, visual odometry errs by a share of the way and of the turn (docs/benchmarks.md: 0.2 to 0.3 % over a
// drive; from scan to scan it is the noise of its window).
Mat6 VioPrior::step_covariance(Time end) const {
  constexpr double kWayShare = 0.01, kTurnShare = 0.01, kStep_m = 2e-3, kStep_rad = 5e-4;
  const std::optional<MotionPath> visual = visual_path_since_fix(end);
  if (!visual) return fallback_.step_covariance(end);
  const double step_m = kWayShare * visual->end_pose().translation.norm() + kStep_m;
  const double turn_rad = kTurnShare * visual->end_pose().angle() + kStep_rad;
  Vec6 sigma;
  sigma << Vec3::Constant(turn_rad), Vec3::Constant(step_m);
  return sigma.cwiseAbs2().asDiagonal();
}

void VioPrior::correct(const OdometryFix& fix) {
  Vec3 unseen_velocity_base_mps = Vec3::Zero();
  if (const std::optional<OdometryFix>& last = fallback_.fixes().last(); last && fix.stamp > last->stamp) {
    T_start_base_ = T_start_base_ * path(last->stamp, fix.stamp).end_pose();
    unseen_velocity_base_mps = fallback_.path(last->stamp, fix.stamp).end_pose().translation /
                               seconds_between(last->stamp, fix.stamp);
  }
  fallback_.correct(fix);
  if (config_.lidar_aid) vio_.add(aid(fix, unseen_velocity_base_mps));
  imu_.forget_before(last_image_ ? std::min(*last_image_, fix.stamp) : fix.stamp);
}

// Pose, velocity and bias that the LiDAR side vouches for. Where it was blind it has only followed this prior:
// there the velocity is that of the fallback, lest a restart begin with what made it necessary.
VioAid VioPrior::aid(const OdometryFix& fix, const Vec3& unseen_velocity_base_mps) const {
  VioAid aid;
  aid.stamp = fix.stamp;
  aid.T_odom_imu = fix.T_odom_base * rig_.imu.T_base_imu;
  const Vec3 omega_base = fallback_.fixes().twist().head<3>();
  const Vec3 v_base =
      unseen_velocity_base_mps +
      fix.observed_translation * (fallback_.fixes().twist().tail<3>() - unseen_velocity_base_mps);
  aid.v_odom_mps = fix.T_odom_base.rotation * (v_base + omega_base.cross(rig_.imu.T_base_imu.translation));
  aid.bias.gyro_radps = fallback_.bias().gyro_radps;
  if (vio_.status() == VioStatus::tracking) aid.bias.accel_mps2 = vio_.state().bias.accel_mps2;
  return aid;
}

void VioPrior::add_scan(Time stamp, const Cloud& points_lidar, const SE3& T_odom_base) {
  if (!config_.lidar_depth) return;
  const StageTimer timer(clock_, "depth_map");
  depth_.add(stamp, points_lidar, T_odom_base);
}

std::optional<VisualReport> VioPrior::visual_report() const {
  return VisualReport{vio_.restarts(), T_start_base_};
}

}  // namespace vsslam

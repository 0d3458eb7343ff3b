#include "scenarios/health/doctor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scenarios/health/diagnosis.h"

namespace vsslam {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Scans farther apart are not compared: the robot may have done anything between them.
constexpr double kComparable_s = 1.0;
// Slower turning is not compared: ten times the bias of a cheap gyroscope, about 0.5 deg/s.
constexpr double kTurning_radps = 5 * kDegree;
// Less turning in all tells nothing certain: some sixty scans of the slowest turning that counts.
constexpr double kEnoughTurning_rad = 30 * kDegree;
// Slower driving is not compared: a scan is good to a centimetre, which is a tenth of what lies between two at 10 Hz.
constexpr double kDriving_mps = 0.3;
// Less travel in all tells nothing certain.
constexpr double kEnoughTravel_m = 3;
// Slower counts as rest: what the LiDAR's own noise makes of a robot that stands.
constexpr double kRest_mps = 0.1, kRest_radps = 2 * kDegree;
// Fewer samples of rest do not average the vibration of an engine.
constexpr int64_t kEnoughRest = 50;
// Below it the noise of a small sensor, two to four grey levels, is as large as the contrast that corners have.
constexpr double kDarkGrey = 20;

/// Wheel angles at a stamp between samples; nullopt outside of them.
std::optional<Vec2> wheels_at(const std::deque<WheelSample>& samples, Time stamp) {
  const auto after = std::lower_bound(samples.begin(), samples.end(), stamp,
                                      [](const WheelSample& s, Time t) { return s.stamp < t; });
  if (after == samples.end()) return std::nullopt;
  const Vec2 b(after->left_rad, after->right_rad);
  if (after->stamp == stamp) return b;
  if (after == samples.begin()) return std::nullopt;
  const WheelSample& before = *(after - 1);
  const Vec2 a(before.left_rad, before.right_rad);
  return a + (b - a) * (seconds_between(before.stamp, stamp) / seconds_between(before.stamp, after->stamp));
}

template <class Sample>
void keep_recent(std::deque<Sample>& samples) {
  while (seconds_between(samples.front().stamp, samples.back().stamp) > 2 * kComparable_s)
    samples.pop_front();
}

std::optional<double> scale_of(const MotionAgreement& agreement, double enough) {
  return agreement.total() >= enough ? agreement.scale() : std::nullopt;
}

}  // namespace

void SensorDoctor::ForceSum::add(const ImuSample& sample, const Mat3& R_base_imu) {
  sum_base += R_base_imu * sample.accel_mps2;
  sum_of_norms += sample.accel_mps2.norm();
  ++count;
}

void SensorDoctor::add(const ImuSample& sample) {
  imu_clock_.add(sample.stamp);
  force_.add(sample, rig_.imu.T_base_imu.matrix3());
  imu_.push_back(sample);
  keep_recent(imu_);
}

void SensorDoctor::add(const WheelSample& sample) {
  wheel_clock_.add(sample.stamp);
  wheels_.push_back(wheel_turns_.unwrapped(sample));
  keep_recent(wheels_);
}

void SensorDoctor::add(const CameraFrame& image) {
  camera_clock_.add(image.stamp);
  if (image.grey.empty()) return;
  const int64_t sum = std::accumulate(image.grey.begin(), image.grey.end(), int64_t{0});
  const double grey = static_cast<double>(sum) / static_cast<double>(image.grey.size());
  grey_sum_ += grey;
  // Two black images are the same without being frozen.
  if (grey < kDarkGrey) {
    ++dark_;
  } else if (image.grey == last_grey_) {
    ++frozen_;
  }
  last_grey_ = image.grey;
}

void SensorDoctor::add(const LidarScan& scan, const ScanReport& report) {
  if (lidar_clock_.count() == 0) {
    first_prior_only_ = report.used_prior_only;
    first_unconverged_ = !report.converged;
  }
  lidar_clock_.add(scan.stamp);
  points_ += static_cast<int64_t>(scan.points.size());
  without_points_ += scan.points.empty();
  const std::optional<StampedPose> last = last_odom_base_;
  last_odom_base_.reset();
  if (report.used_prior_only) return;
  last_odom_base_ = StampedPose{scan.stamp, report.T_odom_base};
  if (!last || !(last->stamp < scan.stamp) || seconds_between(last->stamp, scan.stamp) > kComparable_s)
    return;
  const double dt_s = seconds_between(last->stamp, scan.stamp);
  const SE3 T_last_base = last->pose.inverse() * report.T_odom_base;
  const Vec3 rotation_base = so3_log(T_last_base.rotation);
  compare_gyro(last->stamp, scan.stamp, rotation_base);
  compare_wheels(last->stamp, scan.stamp, T_last_base.translation.x(), rotation_base.z());
  if (T_last_base.translation.norm() < kRest_mps * dt_s && rotation_base.norm() < kRest_radps * dt_s)
    weigh_force(last->stamp, scan.stamp);
  forget_before(scan.stamp);
}

// The gyroscope's rates are summed as vectors: within one interval they hardly change their axis, and a rate in degrees,
// which turns more than once, must not wrap.
void SensorDoctor::compare_gyro(Time from, Time to, const Vec3& rotation_base) {
  if (imu_.size() < 2 || imu_.front().stamp > from || imu_.back().stamp < to) return;
  Vec3 turned_imu = Vec3::Zero();
  for (size_t i = 1; i < imu_.size(); ++i) {
    const Time begin = std::max(imu_[i - 1].stamp, from), end = std::min(imu_[i].stamp, to);
    if (begin < end)
      turned_imu += 0.5 * (imu_[i - 1].gyro_radps + imu_[i].gyro_radps) * seconds_between(begin, end);
  }
  const Vec3 turned_base = rig_.imu.T_base_imu.rotation * turned_imu;
  const double least_rad = kTurning_radps * seconds_between(from, to);
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(rotation_base[axis]) >= least_rad)
      gyro_axis_[static_cast<size_t>(axis)].add(rotation_base[axis], turned_base[axis]);
  if (rotation_base.norm() < least_rad) return;
  // Along the axis that the LiDAR saw, and across it.
  const Vec3 axis = rotation_base.normalized();
  gyro_.add(rotation_base.norm(), turned_base.dot(axis));
  const double across = (turned_base - turned_base.dot(axis) * axis).norm();
  gyro_.add(0, across);
}

void SensorDoctor::compare_wheels(Time from, Time to, double forward_m, double yaw_rad) {
  const auto begin = wheels_at(wheels_, from), end = wheels_at(wheels_, to);
  if (!begin || !end) return;
  const Vec2 rolled_m = rig_.wheels.wheel_radius_m * (*end - *begin);
  const double dt_s = seconds_between(from, to);
  if (std::abs(forward_m) >= kDriving_mps * dt_s) travel_.add(forward_m, rolled_m.mean());
  if (std::abs(yaw_rad) >= kTurning_radps * dt_s)
    yaw_.add(yaw_rad, (rolled_m.y() - rolled_m.x()) / rig_.wheels.effective_track_m);
}

void SensorDoctor::weigh_force(Time from, Time to) {
  for (const ImuSample& sample : imu_)
    if (from < sample.stamp && sample.stamp <= to) force_at_rest_.add(sample, rig_.imu.T_base_imu.matrix3());
}

// The last sample before it is kept: it begins the next interval.
void SensorDoctor::forget_before(Time stamp) {
  while (imu_.size() > 1 && imu_[1].stamp <= stamp) imu_.pop_front();
  while (wheels_.size() > 1 && wheels_[1].stamp <= stamp) wheels_.pop_front();
}

ImuHealth SensorDoctor::imu_health() const {
  ImuHealth imu;
  imu.gravity_at_rest = force_at_rest_.count >= kEnoughRest;
  const ForceSum& force = imu.gravity_at_rest ? force_at_rest_ : force_;
  if (force.count > 0) {
    const double count = static_cast<double>(force.count);
    // On the move it is the size that can be told: the direction sways.
    imu.gravity_mps2 = imu.gravity_at_rest ? force.sum_base.norm() / count : force.sum_of_norms / count;
    if (force.sum_base.norm() > 0)
      imu.gravity_tilt_deg = std::acos(std::clamp(force.sum_base.normalized().z(), -1.0, 1.0)) / kDegree;
  }
  imu.gyro_scale = scale_of(gyro_, kEnoughTurning_rad);
  if (imu.gyro_scale) imu.gyro_correlation = gyro_.correlation();
  for (size_t axis = 0; axis < 3; ++axis)
    imu.gyro_axis_scale[axis] = scale_of(gyro_axis_[axis], kEnoughTurning_rad);
  return imu;
}

CameraHealth SensorDoctor::camera_health() const {
  CameraHealth camera;
  if (camera_clock_.count() > 0) camera.grey_mean = grey_sum_ / static_cast<double>(camera_clock_.count());
  camera.dark = dark_;
  camera.frozen = frozen_;
  return camera;
}

void SensorDoctor::tell_times(const SampleClock& clock, SensorHealth& sensor) const {
  sensor.used = clock.count();
  const auto interval_s = clock.usual_interval_s();
  if (!interval_s || *interval_s <= 0) return;
  Time begin = *clock.first(), end = *clock.last();
  for (const SampleClock* other : {&imu_clock_, &wheel_clock_, &lidar_clock_, &camera_clock_}) {
    if (other->count() == 0) continue;
    begin = std::min(begin, *other->first());
    end = std::max(end, *other->last());
  }
  sensor.rate_hz = 1 / *interval_s;
  sensor.share_of_time =
      std::min(1.0, static_cast<double>(clock.count()) /
                        (std::floor(seconds_between(begin, end) / *interval_s + 0.01) + 1));
  const auto gap = clock.longest_gap(end);
  sensor.longest_gap_s = gap->length_s;
  sensor.longest_gap_at_s = seconds_between(begin, gap->begin);
}

Health SensorDoctor::health(const OdometryHealth& odometry, const SourceHealth& source) const {
  Health health;
  health.imu = imu_health();
  health.camera = camera_health();
  health.wheels.travel_scale = scale_of(travel_, kEnoughTravel_m);
  health.wheels.yaw_scale = scale_of(yaw_, kEnoughTurning_rad);
  if (lidar_clock_.count() > 0)
    health.lidar.points_mean = static_cast<double>(points_) / static_cast<double>(lidar_clock_.count());
  health.lidar.without_points = without_points_;
  tell_times(imu_clock_, health.imu);
  tell_times(wheel_clock_, health.wheels);
  tell_times(lidar_clock_, health.lidar);
  tell_times(camera_clock_, health.camera);
  health.imu.dropped = source.imu_dropped;
  health.wheels.dropped = source.wheels_dropped;
  health.lidar.dropped = source.lidar_dropped;
  health.camera.dropped = source.camera_dropped;
  health.odometry = odometry;
  if (first_prior_only_ && odometry.scans_prior_only > 0) --health.odometry.scans_prior_only;
  if (first_unconverged_ && odometry.scans_unconverged > 0) --health.odometry.scans_unconverged;
  health.repairs = source.repairs;
  health.repairs.insert(health.repairs.end(), odometry.repairs.begin(), odometry.repairs.end());
  health.warnings = odometry.warnings;
  health.warnings.insert(health.warnings.end(), source.warnings.begin(), source.warnings.end());
  diagnose(rig_, health);
  return health;
}

}  // namespace vsslam

#include "slam/inertial/dead_reckoning.h"

#include <algorithm>
#include <cmath>

#include "slam/inertial/pose_covariance.h"

namespace vsslam {

namespace {

constexpr double kWheelStep_m = 1e-3;  // of an encoder, and of a wheel that rolls over the grain of the floor

}  // namespace

DeadReckoning::DeadReckoning(const InertialConfig& config, const RigCalibration& rig, bool use_gyro,
                             bool use_wheels)
    : config_(config),
      imu_sheet_(rig.imu),
      use_gyro_(use_gyro),
      use_wheels_(use_wheels),
      T_base_imu_(rig.imu.T_base_imu),
      imu_(track_limits(config)),
      wheels_(rig.wheels, config.max_gap_s),
      gyro_bias_(rig.imu.gyro_bias_walk_radps2_rthz),
      fixes_(config) {}

void DeadReckoning::start(const InitialState& state) {
  gyro_bias_.start(state.gyro_bias_radps, state.gyro_bias_sigma_radps);
  fixes_.start(state.at_rest);
}

void DeadReckoning::add(const ImuSample& sample) {
  if (use_gyro_) imu_.add(sample);
}

void DeadReckoning::add(const WheelSample& sample) {
  if (use_wheels_) wheels_.add(sample);
}

// The stamps of the samples, and fillers where there are none.
std::vector<Time> DeadReckoning::knot_stamps(Time begin, Time end) const {
  std::vector<Time> stamps;
  for (const ImuSample& sample : imu_.samples()) stamps.push_back(sample.stamp);
  if (stamps.empty())
    for (const WheelSample& sample : wheels_.samples()) stamps.push_back(sample.stamp);
  constexpr Duration kLongest{20'000'000};
  std::vector<Time> knots{begin};
  stamps.push_back(end);
  for (const Time stamp : stamps) {
    if (stamp <= begin || stamp > end) continue;
    while (stamp - knots.back() > kLongest) knots.push_back(knots.back() + kLongest);
    knots.push_back(stamp);
  }
  return knots;
}

// Mean angular velocity between a and b: gyroscope, else wheels, else as before.
Vec3 DeadReckoning::omega_base(Time a, Time b, const Vec6& fallback) const {
  const auto gyro_a = imu_.at(a), gyro_b = imu_.at(b);
  if (gyro_a && gyro_b)
    return T_base_imu_.rotation * (0.5 * (gyro_a->gyro_radps + gyro_b->gyro_radps) - gyro_bias_.bias_radps());
  const auto wheels_a = wheels_.at(a), wheels_b = wheels_.at(b);
  if (wheels_a && wheels_b) return {0, 0, (wheels_b->yaw_rad - wheels_a->yaw_rad) / seconds_between(a, b)};
  return fallback.head<3>();
}

// Arc length along the base's velocity between a and b: wheels (forward only), else as before.
Vec3 DeadReckoning::step_base(Time a, Time b, const Vec6& fallback) const {
  const auto wheels_a = wheels_.at(a), wheels_b = wheels_.at(b);
  if (wheels_a && wheels_b) return {wheels_b->forward_m - wheels_a->forward_m, 0, 0};
  return fallback.tail<3>() * seconds_between(a, b);
}

MotionPath DeadReckoning::path(Time begin, Time end) const {
  MotionPath path(begin);
  const Vec6 fallback = fixes_.twist();
  const std::vector<Time> knots = knot_stamps(begin, end);
  SE3 T_begin_t;
  for (size_t i = 1; i < knots.size(); ++i) {
    const Vec3 rotation =
        omega_base(knots[i - 1], knots[i], fallback) * seconds_between(knots[i - 1], knots[i]);
    const Vec3 step = step_base(knots[i - 1], knots[i], fallback);
    // Constant curvature: the step is bent by half the rotation.
    T_begin_t = T_begin_t * SE3(so3_exp(rotation), so3_exp(0.5 * rotation) * step);
    path.append(knots[i], T_begin_t);
  }
  return path;
}

// What the sensors leave open, the velocity of the last fixes says.
Mat6 DeadReckoning::covariance(Time end) const {
  const auto& last = fixes_.last();
  Mat6 covariance = fixes_.covariance(end);
  if (!last || end <= last->stamp) return covariance;
  const double dt_s = seconds_between(last->stamp, end);
  const bool turned = imu_.at(last->stamp) && imu_.at(end);
  const bool rolled = wheels_.at(last->stamp) && wheels_.at(end);
  if (!turned && !rolled) return covariance;
  const SE3 T_last_end = path(last->stamp, end).end_pose();
  const Mat6 known = moved_covariance(last->covariance, T_last_end);
  const double way_m = T_last_end.translation.norm();
  if (turned) {
    const double white = config_.imu_noise_factor * imu_sheet_.gyro_noise_radps_rthz;
    covariance.topLeftCorner<3, 3>() = known.topLeftCorner<3, 3>();
    covariance.diagonal().head<3>().array() += white * white * dt_s + gyro_bias_.variance() * dt_s * dt_s;
  } else {
    const double turn_rad = config_.wheel_turn_slip * T_last_end.angle() + 0.01 * dt_s;
    covariance(2, 2) = known(2, 2) + turn_rad * turn_rad;
  }
  // Wheels say how far, not up or down, nor aside.
  if (rolled) {
    const double forward_m = config_.wheel_slip * way_m + kWheelStep_m, aside_m = 2 * forward_m;
    covariance.bottomRightCorner<3, 3>() = known.bottomRightCorner<3, 3>();
    covariance.diagonal().tail<3>() += Vec3(forward_m * forward_m, aside_m * aside_m, aside_m * aside_m);
  }
  covariance.topRightCorner<3, 3>().setZero();
  covariance.bottomLeftCorner<3, 3>().setZero();
  return covariance;
}

void DeadReckoning::correct(const OdometryFix& fix) {
  const auto& last = fixes_.last();
  if (use_gyro_ && last && fix.stamp > last->stamp && imu_.at(last->stamp) && imu_.at(fix.stamp)) {
    const Quat q_gyro = path(last->stamp, fix.stamp).end_pose().rotation;
    const Quat q_lidar = last->T_odom_base.rotation.conjugate() * fix.T_odom_base.rotation;
    const Mat3 R_imu_base = T_base_imu_.matrix3().transpose();
    gyro_bias_.correct(R_imu_base * so3_log(q_gyro.conjugate() * q_lidar),
                       R_imu_base * fix.observed_rotation * R_imu_base.transpose(),
                       std::sqrt(fix.covariance.topLeftCorner<3, 3>().trace() / 3),
                       seconds_between(last->stamp, fix.stamp));
  }
  fixes_.add(fix);
  imu_.forget_before(fix.stamp);
  wheels_.forget_before(fix.stamp);
}

}  // namespace vsslam

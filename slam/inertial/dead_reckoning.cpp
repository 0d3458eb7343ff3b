#include "slam/inertial/dead_reckoning.h"

#include <algorithm>

namespace vsslam {

DeadReckoning::DeadReckoning(const InertialConfig& config, const RigCalibration& rig, bool use_gyro,
                             bool use_wheels)
    : use_gyro_(use_gyro),
      use_wheels_(use_wheels),
      T_base_imu_(rig.imu.T_base_imu),
      imu_(track_limits(config)),
      wheels_(rig.wheels, config.max_gap_s),
      gyro_bias_(rig.imu.gyro_bias_walk_radps2_rthz, config.lidar_rotation_sigma_rad) {}

void DeadReckoning::start(const InitialState& state) {
  gyro_bias_.start(state.gyro_bias_radps, state.gyro_bias_sigma_radps);
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

void DeadReckoning::correct(const OdometryFix& fix) {
  const auto& last = fixes_.last();
  if (use_gyro_ && last && fix.stamp > last->stamp && imu_.at(last->stamp) && imu_.at(fix.stamp)) {
    const Quat q_gyro = path(last->stamp, fix.stamp).end_pose().rotation;
    const Quat q_lidar = last->T_odom_base.rotation.conjugate() * fix.T_odom_base.rotation;
    const Mat3 R_imu_base = T_base_imu_.matrix3().transpose();
    gyro_bias_.correct(R_imu_base * so3_log(q_gyro.conjugate() * q_lidar),
                       R_imu_base * fix.observed_rotation * R_imu_base.transpose(),
                       seconds_between(last->stamp, fix.stamp));
  }
  fixes_.add(fix);
  imu_.forget_before(fix.stamp);
  wheels_.forget_before(fix.stamp);
}

}  // namespace vsslam

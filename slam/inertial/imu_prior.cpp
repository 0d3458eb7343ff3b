#include "slam/inertial/imu_prior.h"

#include <algorithm>

namespace vsslam {

ImuPrior::ImuPrior(const InertialConfig& config, const RigCalibration& rig)
    : config_(config),
      imu_calibration_(rig.imu),
      imu_(track_limits(config)),
      gyro_bias_(rig.imu.gyro_bias_walk_radps2_rthz, config.lidar_rotation_sigma_rad) {}

void ImuPrior::start(const InitialState& state) {
  gyro_bias_.start(state.gyro_bias_radps, state.gyro_bias_sigma_radps);
  accel_bias_mps2_ = state.accel_bias_mps2;
  state_.T_odom_imu = state.T_odom_base * imu_calibration_.T_base_imu;
  velocity_variance_ = state.at_rest ? 1e-6 : 1.0;
}

bool ImuPrior::predict(Time begin, Time end, State& state, MotionPath* path) const {
  const State start = state;
  const Vec3 gravity_odom(0, 0, -imu_calibration_.gravity_mps2);
  const SE3& T_base_imu = imu_calibration_.T_base_imu;
  ImuPreintegration motion(imu_calibration_, {gyro_bias_.bias_radps(), accel_bias_mps2_});
  auto before = imu_.at(begin);
  if (!before) return false;
  std::vector<Time> stamps;
  for (const ImuSample& sample : imu_.samples())
    if (sample.stamp > begin && sample.stamp < end) stamps.push_back(sample.stamp);
  stamps.push_back(end);
  for (const Time stamp : stamps) {
    if (stamp <= before->stamp) continue;
    const auto now = imu_.at(stamp);
    if (!now || seconds_between(before->stamp, stamp) > config_.max_gap_s) return false;
    motion.add(seconds_between(before->stamp, stamp), before->gyro_radps, before->accel_mps2, now->gyro_radps,
               now->accel_mps2);
    before = now;
    const double dt = motion.dt_s();
    const Quat& q = start.T_odom_imu.rotation;
    state.v_odom = start.v_odom + gravity_odom * dt + q * motion.delta_v();
    state.T_odom_imu = {q * motion.delta_R(), start.T_odom_imu.translation + start.v_odom * dt +
                                                  0.5 * gravity_odom * dt * dt + q * motion.delta_p()};
    if (path)
      path->append(stamp, T_base_imu * start.T_odom_imu.inverse() * state.T_odom_imu * T_base_imu.inverse());
  }
  return true;
}

MotionPath ImuPrior::path(Time begin, Time end) const {
  MotionPath path(begin);
  State state = state_;
  if (predict(begin, end, state, &path)) return path;
  // Samples are missing: constant velocity of the odometry.
  MotionPath constant(begin);
  constant.append(end, SE3::exp(fixes_.twist() * seconds_between(begin, end)));
  return constant;
}

// Scalar Kalman filter on the velocity: an unmodelled acceleration of 0.1 m/s^2 (tilt, accelerometer bias)
// between scans, measured by the displacement that the LiDAR saw beyond the predicted one.
void ImuPrior::correct_velocity(const OdometryFix& fix, const State& predicted, const State& measured,
                                double dt_s) {
  constexpr double kUnmodelledAccel = 0.1;
  velocity_variance_ += kUnmodelledAccel * kUnmodelledAccel * dt_s * dt_s;
  const double sigma_mps = config_.lidar_position_sigma_m * std::sqrt(2.0) / dt_s;
  const double gain = velocity_variance_ / (velocity_variance_ + sigma_mps * sigma_mps);
  const Mat3 R_odom_base = fix.T_odom_base.matrix3();
  const Mat3 observed_odom = R_odom_base * fix.observed_translation * R_odom_base.transpose();
  const Vec3 innovation = (measured.T_odom_imu.translation - predicted.T_odom_imu.translation) / dt_s;
  state_.v_odom = predicted.v_odom + gain * (observed_odom * innovation);
  if (fix.observed_translation.trace() > 2.5) velocity_variance_ *= 1.0 - gain;
}

void ImuPrior::correct(const OdometryFix& fix) {
  State measured;
  measured.T_odom_imu = fix.T_odom_base * imu_calibration_.T_base_imu;
  const auto last = fixes_.last();
  fixes_.add(fix);
  if (last && fix.stamp > last->stamp) {
    const double dt_s = seconds_between(last->stamp, fix.stamp);
    State predicted = state_;
    if (predict(last->stamp, fix.stamp, predicted, nullptr)) {
      gyro_bias_.correct(so3_log(predicted.T_odom_imu.rotation.conjugate() * measured.T_odom_imu.rotation),
                         fix.observed_rotation, dt_s);
      correct_velocity(fix, predicted, measured, dt_s);
    } else {
      state_.v_odom = (measured.T_odom_imu.translation - state_.T_odom_imu.translation) / dt_s;
      velocity_variance_ = 1.0;
    }
    if (!(state_.v_odom.norm() < config_.max_speed_mps)) state_.v_odom.setZero();
  }
  state_.T_odom_imu = measured.T_odom_imu;
  imu_.forget_before(fix.stamp);
}

}  // namespace vsslam

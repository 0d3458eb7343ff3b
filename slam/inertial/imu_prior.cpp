#include "slam/inertial/imu_prior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "slam/inertial/pose_covariance.h"

namespace vsslam {

namespace {

ImuCalibration believed(ImuCalibration imu, double noise_factor) {
  imu.gyro_noise_radps_rthz *= noise_factor;
  imu.accel_noise_mps2_rthz *= noise_factor;
  return imu;
}

double square(double x) {
  return x * x;
}

}  // namespace

// Derivative of the state after a preintegrated motion by the state before it (Forster et al. 2017, section VI); with
// position perturbed in the body's frame.
ImuPrior::Mat18 ImuPrior::transition(const ImuPreintegration& motion, const Mat3& R_before, const Mat3& R_after) {
  const double dt = motion.dt_s();
  const Mat3 R_j_i = motion.delta_R().toRotationMatrix().transpose();
  const Mat3 R_j_odom = R_after.transpose();
  const auto& J = motion.bias_jacobian();
  Mat18 F = Mat18::Identity();
  F.block<3, 3>(0, 0) = R_j_i;
  F.block<3, 6>(0, 9) = J.topRows<3>();
  F.block<3, 3>(3, 0) = -R_j_i * hat(motion.delta_p());
  F.block<3, 3>(3, 3) = R_j_i;
  F.block<3, 3>(3, 6) = dt * R_j_odom;
  F.block<3, 6>(3, 9) = R_j_i * J.bottomRows<3>();
  F.block<3, 3>(3, 15) = 0.5 * dt * dt * R_j_odom;
  F.block<3, 3>(6, 15) = dt * Mat3::Identity();
  F.block<3, 3>(6, 0) = -R_before * hat(motion.delta_v());
  F.block<3, 6>(6, 9) = R_before * J.middleRows<3>(3);
  return F;
}

// Of the motion's own noise, in the errors of the state after it.
ImuPrior::Mat18 ImuPrior::motion_noise(const ImuPreintegration& motion, const Mat3& R_before, const ImuCalibration& imu) {
  const Mat3 R_j_i = motion.delta_R().toRotationMatrix().transpose();
  Eigen::Matrix<double, kStates, 9> G = Eigen::Matrix<double, kStates, 9>::Zero();
  G.block<3, 3>(0, 0).setIdentity();
  G.block<3, 3>(6, 3) = R_before;
  G.block<3, 3>(3, 6) = R_j_i;
  Mat18 Q = G * motion.covariance() * G.transpose();
  Q.diagonal().segment<3>(9).array() += square(imu.gyro_bias_walk_radps2_rthz) * motion.dt_s();
  Q.diagonal().segment<3>(12).array() += square(imu.accel_bias_walk_mps3_rthz) * motion.dt_s();
  return Q;
}

void ImuPrior::State::add_to_rest(const Vec18& change) {
  v_odom += change.segment<3>(6);
  bias.gyro_radps += change.segment<3>(9);
  bias.accel_mps2 += change.segment<3>(12);
  gravity_odom += change.tail<3>();
}

ImuPrior::ImuPrior(const InertialConfig& config, const RigCalibration& rig)
    : config_(config),
      sheet_(believed(rig.imu, config.imu_noise_factor)),
      imu_(track_limits(config)),
      fixes_(config) {}

void ImuPrior::start(const InitialState& state) {
  constexpr double kRestSpeed_mps = 1e-3;
  constexpr double kMovingTilt_rad = 0.1;  // level by the mean specific force, while braking with 1 m/s^2
  fixes_.start(state.at_rest);
  start_bias_ = {state.gyro_bias_radps, state.accel_bias_mps2};
  gyro_bias_sigma_radps_ = state.gyro_bias_sigma_radps;
  const double bias = config_.accel_bias_sigma_mps2, g = sheet_.gravity_mps2;
  const double tilt = state.at_rest ? bias / g : kMovingTilt_rad;
  state_.T_odom_imu = state.T_odom_base * sheet_.T_base_imu;
  state_.bias = start_bias_;
  state_.gravity_odom = {0, 0, -g};
  state_.P.setZero();
  state_.P.diagonal().head<6>().setConstant(1e-8);  // the first pose defines odom
  state_.P.diagonal().segment<3>(6).setConstant(
      square(state.at_rest ? kRestSpeed_mps : config_.max_speed_mps / 3));
  state_.P.diagonal().segment<3>(9).setConstant(square(gyro_bias_sigma_radps_));
  state_.P.diagonal().segment<3>(12).setConstant(square(bias));
  state_.P.diagonal().segment<2>(15).setConstant(square(tilt * g));
  rest_.reset();
  if (!state.at_rest) return;
  // Up was found from the specific force f = b - R' gravity: a level bias of b is a tilt of b / g.
  const Mat3 R_imu_odom = state_.T_odom_imu.matrix3().transpose();
  rest_ = ImuBias{state.gyro_bias_radps, state.accel_bias_mps2 - R_imu_odom * state_.gravity_odom};
  rest_scans_ = 1;
  Eigen::Matrix<double, 3, kStates> H = Eigen::Matrix<double, 3, kStates>::Zero();
  H.middleCols<3>(12).setIdentity();
  H.rightCols<3>() = -R_imu_odom;
  const Mat3 noise = square(0.02 * bias) * Mat3::Identity();
  const Eigen::Matrix<double, kStates, 3> K =
      (H * state_.P * H.transpose() + noise).ldlt().solve(H * state_.P).transpose();
  state_.P -= K * H * state_.P;
  state_.P = 0.5 * (state_.P + state_.P.transpose()).eval();
}

std::optional<ImuPrior::State> ImuPrior::predict(Time begin, Time end, MotionPath* path) const {
  const Vec3& gravity_odom = state_.gravity_odom;
  const SE3& T_base_imu = sheet_.T_base_imu;
  ImuPreintegration motion(sheet_, state_.bias);
  auto before = imu_.at(begin);
  if (!before) return std::nullopt;
  std::vector<Time> stamps;
  for (const ImuSample& sample : imu_.samples())
    if (sample.stamp > begin && sample.stamp < end) stamps.push_back(sample.stamp);
  stamps.push_back(end);
  const Quat& q = state_.T_odom_imu.rotation;
  State state = state_;
  for (const Time stamp : stamps) {
    if (stamp <= before->stamp) continue;
    const auto now = imu_.at(stamp);
    if (!now || seconds_between(before->stamp, stamp) > config_.max_gap_s) return std::nullopt;
    motion.add(seconds_between(before->stamp, stamp), before->gyro_radps, before->accel_mps2, now->gyro_radps,
               now->accel_mps2);
    before = now;
    const double dt = motion.dt_s();
    state.v_odom = state_.v_odom + gravity_odom * dt + q * motion.delta_v();
    state.T_odom_imu = {q * motion.delta_R(), state_.T_odom_imu.translation + state_.v_odom * dt +
                                                  0.5 * gravity_odom * dt * dt + q * motion.delta_p()};
    if (path)
      path->append(stamp, T_base_imu * state_.T_odom_imu.inverse() * state.T_odom_imu * T_base_imu.inverse());
  }
  const Mat3 R = q.toRotationMatrix();
  const Mat18 F = transition(motion, R, state.T_odom_imu.matrix3());
  state.P = F * state_.P * F.transpose() + motion_noise(motion, R, sheet_);
  return state;
}

MotionPath ImuPrior::path(Time begin, Time end) const {
  MotionPath path(begin);
  if (predict(begin, end, &path)) return path;
  // Samples are missing: constant velocity of the odometry.
  MotionPath constant(begin);
  constant.append(end, SE3::exp(fixes_.twist() * seconds_between(begin, end)));
  return constant;
}

Mat6 ImuPrior::covariance(Time end) const {
  const auto& last = fixes_.last();
  const std::optional<State> state = last ? predict(last->stamp, end, nullptr) : std::nullopt;
  if (!state) return fixes_.covariance(end);
  return moved_covariance(state->P.topLeftCorner<6, 6>(), sheet_.T_base_imu.inverse());
}

// After a gap, or a state gone wrong: the velocity of the fixes, the biases as at the start.
void ImuPrior::restart(const OdometryFix& fix, double dt_s) {
  const Mat3 gravity = state_.P.bottomRightCorner<3, 3>();
  const double speed_sigma_mps = config_.unknown_accel_mps2 * std::max(dt_s, 0.1);
  state_.v_odom = fix.T_odom_base.rotation * fixes_.twist().tail<3>();
  state_.bias = start_bias_;
  state_.P.setZero();
  state_.P.topLeftCorner<6, 6>() = moved_covariance(fix.covariance, sheet_.T_base_imu);
  state_.P.diagonal().segment<3>(6).setConstant(square(speed_sigma_mps));
  state_.P.diagonal().segment<3>(9).setConstant(square(gyro_bias_sigma_radps_));
  state_.P.diagonal().segment<3>(12).setConstant(square(config_.accel_bias_sigma_mps2));
  state_.P.bottomRightCorner<3, 3>() = gravity;
}

// Quiet, not known to move, and feeling what it felt at the start, at rest: at constant speed an IMU is as quiet, and a
// robot that sets off gently feels hardly more, but steadily.
bool ImuPrior::stands(Time from, Time to) {
  constexpr double kSpeed_mps = 0.05, kForce_mps2 = 0.02, kRate_radps = 0.005;
  if (!rest_) return false;
  Vec3 gyro = Vec3::Zero(), accel = Vec3::Zero();
  double count = 0;
  for (const ImuSample& sample : imu_.samples()) {
    if (sample.stamp < from || sample.stamp > to) continue;
    gyro += sample.gyro_radps;
    accel += sample.accel_mps2;
    ++count;
  }
  if (count < 3 || state_.v_odom.norm() > kSpeed_mps) return false;
  gyro /= count, accel /= count;
  // Three sigma of the mean of three axes.
  const double noise = 3 * std::sqrt(3 * sheet_.rate_hz / count) / config_.imu_noise_factor;
  if ((gyro - rest_->gyro_radps).norm() > kRate_radps + noise * sheet_.gyro_noise_radps_rthz ||
      (accel - rest_->accel_mps2).norm() > kForce_mps2 + noise * sheet_.accel_noise_mps2_rthz)
    return false;
  rest_scans_ = std::min(rest_scans_ + 1, 100);  // the mean follows a bias that drifts
  rest_->gyro_radps += (gyro - rest_->gyro_radps) / rest_scans_;
  rest_->accel_mps2 += (accel - rest_->accel_mps2) / rest_scans_;
  return true;
}

// Velocity zero, as measured. The pose is the registration's and stays (a Schmidt update).
void ImuPrior::stand_still() {
  constexpr double kSigma_mps = 2e-3;
  const Mat3 S = state_.P.block<3, 3>(6, 6) + kSigma_mps * kSigma_mps * Mat3::Identity();
  Eigen::Matrix<double, kStates, 3> K = S.ldlt().solve(state_.P.middleRows<3>(6)).transpose();
  K.topRows<6>().setZero();
  const Vec18 change = -K * state_.v_odom;
  Mat18 rest = Mat18::Identity();
  rest.middleCols<3>(6) -= K;
  state_.P = rest * state_.P * rest.transpose() + kSigma_mps * kSigma_mps * K * K.transpose();
  state_.add_to_rest(change);
}

void ImuPrior::correct(const OdometryFix& fix) {
  const auto last = fixes_.last();
  fixes_.add(fix);
  const SE3 T_odom_imu = fix.T_odom_base * sheet_.T_base_imu;
  if (last && fix.stamp > last->stamp) {
    if (std::optional<State> predicted = predict(last->stamp, fix.stamp, nullptr)) {
      const Vec6 shift = (predicted->T_odom_imu.inverse() * T_odom_imu).log();
      const auto change =
          condition_on_pose(predicted->P, shift, moved_covariance(fix.covariance, sheet_.T_base_imu));
      state_ = *predicted;
      state_.add_to_rest(change);
    } else {
      state_.T_odom_imu = T_odom_imu;
      restart(fix, seconds_between(last->stamp, fix.stamp));
    }
  }
  state_.T_odom_imu = T_odom_imu;
  if (last && !(state_.v_odom.norm() < config_.max_speed_mps)) restart(fix, 1);
  if (last && stands(last->stamp, fix.stamp)) stand_still();
  imu_.forget_before(fix.stamp);
}

}  // namespace vsslam

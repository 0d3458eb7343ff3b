#include "slam/inertial/imu_prior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "slam/inertial/pose_covariance.h"

namespace vsslam {

namespace {

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

// G, of the motion's own noise [phi; v; p] into the errors of the state after it.
Eigen::Matrix<double, ImuPrior::kStates, 9> ImuPrior::noise_input(const ImuPreintegration& motion, const Mat3& R_before) {
  Eigen::Matrix<double, kStates, 9> G = Eigen::Matrix<double, kStates, 9>::Zero();
  G.block<3, 3>(0, 0).setIdentity();
  G.block<3, 3>(6, 3) = R_before;
  G.block<3, 3>(3, 6) = motion.delta_R().toRotationMatrix().transpose();
  return G;
}

ImuPrior::Mat18 ImuPrior::motion_noise(const ImuPreintegration& motion, const Mat3& R_before) const {
  const auto G = noise_input(motion, R_before);
  Mat18 Q = G * motion.covariance() * G.transpose();
  Q.diagonal().head<3>().array() += square(config_.gyro_scale_sigma * so3_log(motion.delta_R()).norm());
  Q.diagonal().segment<3>(9).array() += square(sheet_.gyro_bias_walk_radps2_rthz) * motion.dt_s();
  Q.diagonal().segment<3>(12).array() += square(sheet_.accel_bias_walk_mps3_rthz) * motion.dt_s();
  return Q;
}

void ImuPrior::State::add_to_rest(const Vec18& change) {
  v_odom += change.segment<3>(6);
  bias.gyro_radps += change.segment<3>(9);
  bias.accel_mps2 += change.segment<3>(12);
  gravity_odom += change.tail<3>();
}

ImuPrior::ImuPrior(const InertialConfig& config, const RigCalibration& rig, bool use_wheels)
    : config_(config),
      sheet_(rig.imu),
      noise_(rig.imu, config.imu_noise_factor),
      imu_(track_limits(config)),
      without_imu_(config, rig, use_wheels) {}

void ImuPrior::start(const InitialState& state) {
  constexpr double kMovingTilt_rad = 0.1;  // level by the mean specific force, while braking with 1 m/s^2
  sheet_.gyro_noise_radps_rthz = noise_.gyro_radps_rthz();
  sheet_.accel_noise_mps2_rthz = noise_.accel_mps2_rthz();
  start_bias_ = {state.gyro_bias_radps, state.accel_bias_mps2};
  gyro_bias_sigma_radps_ = state.gyro_bias_sigma_radps;
  feels_force_ = state.feels_gravity;
  constexpr double kSteadyFor_s = 0.1;  // an acceleration that nothing measures
  if (!feels_force_) sheet_.accel_noise_mps2_rthz = config_.unknown_accel_mps2 * std::sqrt(kSteadyFor_s);
  const double bias = config_.accel_bias_sigma_mps2, g = feels_force_ ? sheet_.gravity_mps2 : 0;
  const double level_force = state.at_rest ? bias : kMovingTilt_rad * g;
  state_.T_odom_imu = state.T_odom_base * sheet_.T_base_imu;
  state_.bias = start_bias_;
  state_.gravity_odom = {0, 0, -g};
  state_.P.setZero();
  state_.P.diagonal().head<6>().setConstant(1e-8);  // the first pose defines odom
  // At rest or at a constant speed: an IMU is as quiet. Wheels tell, or the second scan.
  state_.P.diagonal().segment<3>(6).setConstant(square(config_.max_speed_mps / 3));
  state_.P.diagonal().segment<3>(9).setConstant(square(gyro_bias_sigma_radps_));
  state_.P.diagonal().segment<3>(12).setConstant(square(bias));
  state_.P.diagonal().segment<2>(15).setConstant(square(level_force));
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

std::optional<ImuPrior::Prediction> ImuPrior::predict(const State& before, Time begin, Time end) const {
  std::optional<ImuSpan> span = cut_span(imu_, begin, end, imu_.max_gap_s());
  if (!span) return std::nullopt;
  if (!feels_force_)
    for (ImuSample& sample : *span) sample.accel_mps2.setZero();
  const Vec3& gravity_odom = before.gravity_odom;
  const Quat& q = before.T_odom_imu.rotation;
  const SE3 T_base_odom = sheet_.T_base_imu * before.T_odom_imu.inverse(), T_imu_base = sheet_.T_base_imu.inverse();
  ImuPreintegration motion(sheet_, before.bias);
  Prediction prediction{before, MotionPath(begin)};
  State& state = prediction.state;
  for (size_t i = 1; i < span->size(); ++i) {
    const ImuSample &a = (*span)[i - 1], &b = (*span)[i];
    if (b.stamp <= a.stamp) continue;
    motion.add(seconds_between(a.stamp, b.stamp), a.gyro_radps, a.accel_mps2, b.gyro_radps, b.accel_mps2);
    const double dt = motion.dt_s();
    state.v_odom = before.v_odom + gravity_odom * dt + q * motion.delta_v();
    state.T_odom_imu = {q * motion.delta_R(), before.T_odom_imu.translation + before.v_odom * dt +
                                                  0.5 * gravity_odom * dt * dt + q * motion.delta_p()};
    prediction.path.append(b.stamp, T_base_odom * state.T_odom_imu * T_imu_base);
  }
  const Mat3 R = q.toRotationMatrix();
  const Mat18 F = transition(motion, R, state.T_odom_imu.matrix3());
  state.P = F * before.P * F.transpose() + motion_noise(motion, R);
  measure_way(before, motion, F, prediction);
  return prediction;
}

// The way of the wheels measures p = R_i' (p_j - p_i), which is off by H e_i + w_p: by the state before the motion and by
// the noise of its preintegration. The state after it is off by e_j = F e_i + G w. So cov(e_j, p) = F P_i H' + G cov(w, w_p).
void ImuPrior::measure_way(const State& before, const ImuPreintegration& motion, const Mat18& F,
                           Prediction& prediction) const {
  constexpr double kSlip = 25;  // five sigma
  const std::optional<Vec3> way_base = without_imu_.way(prediction.path);
  if (!way_base) return;
  State& state = prediction.state;
  const SE3 T_begin_end = prediction.path.end_pose();
  const Mat3 R_imu_base = sheet_.T_base_imu.matrix3().transpose();
  const double dt = motion.dt_s();
  const Mat3 R_before = before.T_odom_imu.matrix3();
  const Mat3 R_i_odom = R_before.transpose();
  Eigen::Matrix<double, 3, kStates> H = Eigen::Matrix<double, 3, kStates>::Zero();
  H.middleCols<3>(0) = hat(R_i_odom * (before.v_odom * dt + 0.5 * dt * dt * before.gravity_odom));
  H.middleCols<3>(6) = dt * R_i_odom;
  H.middleCols<6>(9) = motion.bias_jacobian().bottomRows<3>();
  H.middleCols<3>(15) = 0.5 * dt * dt * R_i_odom;
  const Vec3 sigma_m = way_sigma_m(config_, way_base->norm(), T_begin_end.angle());
  const Mat3 noise = R_imu_base * sigma_m.cwiseAbs2().asDiagonal() * R_imu_base.transpose();
  const Vec3 innovation = R_imu_base * (*way_base - T_begin_end.translation);
  const Mat3 S = H * before.P * H.transpose() + motion.covariance().bottomRightCorner<3, 3>() + noise;
  const auto factor = S.ldlt();
  prediction.slipped = innovation.dot(factor.solve(innovation)) > kSlip;
  if (prediction.slipped) return;
  const Eigen::Matrix<double, kStates, 3> cross =
      F * before.P * H.transpose() + noise_input(motion, R_before) * motion.covariance().rightCols<3>();
  const Eigen::Matrix<double, kStates, 3> K = factor.solve(cross.transpose()).transpose();
  Vec18 change = K * innovation;
  state.P -= K * S * K.transpose();
  state.P = 0.5 * (state.P + state.P.transpose()).eval();
  // What it tells of where the motion began is no motion. That pose stays, and so errs by what it is not moved by.
  const Vec6 start = before.P.topRows<6>() * H.transpose() * factor.solve(innovation);
  const Vec6 start_at_end = F.topLeftCorner<6, 6>() * start;
  change.head<6>() -= start_at_end;
  state.P.topLeftCorner<6, 6>() += start_at_end * start_at_end.transpose();
  state.T_odom_imu = state.T_odom_imu * SE3::exp(change.head<6>());
  state.add_to_rest(change);
  prediction.path = prediction.path.bent(sheet_.T_base_imu.adjoint() * change.head<6>());
}

MotionPath ImuPrior::path(Time begin, Time end) const {
  if (std::optional<Prediction> prediction = predict(state_, begin, end)) return prediction->path;
  return without_imu_.path(begin, end);
}

Mat6 ImuPrior::covariance(Time end) const {
  const auto& last = fixes().last();
  const std::optional<Prediction> prediction = last ? predict(state_, last->stamp, end) : std::nullopt;
  if (!prediction) return without_imu_.covariance(end);
  return moved_covariance(prediction->state.P.topLeftCorner<6, 6>(), sheet_.T_base_imu.inverse());
}

Mat6 ImuPrior::step_covariance(Time end) const {
  State exact = state_;
  exact.P = of_exact_pose(state_.P);
  const auto& last = fixes().last();
  const std::optional<Prediction> prediction = last ? predict(exact, last->stamp, end) : std::nullopt;
  if (!prediction) return without_imu_.step_covariance(end);
  return moved_covariance(prediction->state.P.topLeftCorner<6, 6>(), sheet_.T_base_imu.inverse());
}

// After a gap, or a state gone wrong: the velocity of the fixes, the biases as at the start.
void ImuPrior::restart(const OdometryFix& fix, double dt_s) {
  const Mat3 gravity = state_.P.bottomRightCorner<3, 3>();
  const double speed_sigma_mps = config_.unknown_accel_mps2 * std::max(dt_s, 0.1);
  state_.v_odom = fix.T_odom_base.rotation * fixes().twist().tail<3>();
  state_.bias = start_bias_;
  state_.P.setZero();
  state_.P.topLeftCorner<6, 6>() = moved_covariance(fix.covariance, sheet_.T_base_imu);
  state_.P.diagonal().segment<3>(6).setConstant(square(speed_sigma_mps));
  state_.P.diagonal().segment<3>(9).setConstant(square(gyro_bias_sigma_radps_));
  state_.P.diagonal().segment<3>(12).setConstant(square(config_.accel_bias_sigma_mps2));
  state_.P.bottomRightCorner<3, 3>() = gravity;
}

// Quiet, not known to move (before a speed was ever known: not known to be moving), and feeling what it felt at the start:
// at constant speed an IMU is as quiet, and a robot that sets off gently feels hardly more, but steadily.
bool ImuPrior::stands(Time from, Time to) {
  constexpr double kKnown_mps = 0.1, kSigmas = 9;  // three sigma
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
  if (count < 3) return false;
  const Mat3 speed_covariance = state_.P.block<3, 3>(6, 6);
  const bool known = speed_covariance.trace() < square(kKnown_mps);
  speed_was_known_ = speed_was_known_ || known;
  const bool may_be_none = !speed_was_known_ && state_.v_odom.dot(speed_covariance.ldlt().solve(state_.v_odom)) < kSigmas;
  if (state_.v_odom.norm() > kSpeed_mps && !may_be_none) return false;
  gyro /= count, accel /= count;
  // Three sigma of the mean of three axes.
  const double noise = 3 * std::sqrt(3 * sheet_.rate_hz / count);
  if ((gyro - rest_->gyro_radps).norm() > kRate_radps + noise * sheet_.gyro_noise_radps_rthz ||
      (accel - rest_->accel_mps2).norm() > kForce_mps2 + noise * sheet_.accel_noise_mps2_rthz)
    return false;
  rest_scans_ = std::min(rest_scans_ + 1, 100);  // the mean follows a bias that drifts
  rest_->gyro_radps += (gyro - rest_->gyro_radps) / rest_scans_;
  rest_->accel_mps2 += (accel - rest_->accel_mps2) / rest_scans_;
  return true;
}

// Velocity zero, as measured, and so the way since the last fix. The pose is the registration's and stays: it errs by what
// it is not moved by.
void ImuPrior::stand_still() {
  constexpr double kSigma_mps = 2e-3;
  const Mat3 S = state_.P.block<3, 3>(6, 6) + kSigma_mps * kSigma_mps * Mat3::Identity();
  const Eigen::Matrix<double, kStates, 3> K = S.ldlt().solve(state_.P.middleRows<3>(6)).transpose();
  const Vec18 change = -K * state_.v_odom;
  Mat18 rest = Mat18::Identity();
  rest.middleCols<3>(6) -= K;
  state_.P = rest * state_.P * rest.transpose() + kSigma_mps * kSigma_mps * K * K.transpose();
  state_.P.topLeftCorner<6, 6>() += change.head<6>() * change.head<6>().transpose();
  state_.add_to_rest(change);
}

// No slip lasts for ever: then it is the velocity that is wrong, and the wheels are right. A wrong velocity that grows
// uncertain lets the wheels in for a scan, which is no end of the slip.
void ImuPrior::note_slip(bool slipped, Time since, Time now) {
  constexpr double kLongest_s = 20, kOver_s = 1;
  if (!slipped) {
    if (slipping_since_ && seconds_between(last_slip_, now) > kOver_s) slipping_since_.reset();
    return;
  }
  ++slips_;
  last_slip_ = now;
  if (!slipping_since_) slipping_since_ = since;
  if (seconds_between(*slipping_since_, now) < kLongest_s) return;
  state_.P.middleRows<3>(6).setZero();
  state_.P.middleCols<3>(6).setZero();
  state_.P.diagonal().segment<3>(6).setConstant(square(config_.max_speed_mps / 3));
  slipping_since_.reset();
}

// The accelerometer's stays as unknown as it is where it is worth nothing.
void ImuPrior::measure_noise(Time from, Time to) {
  noise_.listen(imu_.samples(), from, to);
  sheet_.gyro_noise_radps_rthz = noise_.gyro_radps_rthz();
  if (feels_force_) sheet_.accel_noise_mps2_rthz = noise_.accel_mps2_rthz();
}

void ImuPrior::correct(const OdometryFix& fix) {
  const auto last = fixes().last();
  const std::optional<Prediction> predicted =
      last && fix.stamp > last->stamp ? predict(state_, last->stamp, fix.stamp) : std::nullopt;
  constexpr double kRolled_m = 1e-3;  // what an encoder tells from nothing
  const std::optional<double> rolled_m = last ? without_imu_.rolled_m(last->stamp, fix.stamp) : std::nullopt;
  const bool rolls = rolled_m && std::abs(*rolled_m) > kRolled_m;
  without_imu_.correct(fix);
  const SE3 T_odom_imu = fix.T_odom_base * sheet_.T_base_imu;
  if (predicted) {
    const Vec6 shift = (predicted->state.T_odom_imu.inverse() * T_odom_imu).log();
    state_ = predicted->state;
    state_.add_to_rest(condition_on_pose(state_.P, shift, moved_covariance(fix.covariance, sheet_.T_base_imu)));
    note_slip(predicted->slipped, last->stamp, fix.stamp);
  }
  state_.T_odom_imu = T_odom_imu;
  if (last && fix.stamp > last->stamp && !predicted) restart(fix, seconds_between(last->stamp, fix.stamp));
  if (last && !(state_.v_odom.norm() < config_.max_speed_mps)) restart(fix, 1);
  stood_ = last && !rolls && stands(last->stamp, fix.stamp);
  if (stood_) stand_still();
  if (last) measure_noise(last->stamp, fix.stamp);
  imu_.forget_before(fix.stamp);
}

}  // namespace vsslam

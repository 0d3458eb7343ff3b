#include "slam/inertial/rest_alignment.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

struct Spread {
  Vec3 gyro_mean = Vec3::Zero(), accel_mean = Vec3::Zero();
  double gyro_sigma = 0, accel_sigma = 0;  // root of the summed variances
};

Spread spread_of(const std::deque<ImuSample>& samples) {
  Spread s;
  const auto n = static_cast<double>(samples.size());
  for (const ImuSample& sample : samples) {
    s.gyro_mean += sample.gyro_radps / n;
    s.accel_mean += sample.accel_mps2 / n;
  }
  for (const ImuSample& sample : samples) {
    s.gyro_sigma += (sample.gyro_radps - s.gyro_mean).squaredNorm() / n;
    s.accel_sigma += (sample.accel_mps2 - s.accel_mean).squaredNorm() / n;
  }
  s.gyro_sigma = std::sqrt(s.gyro_sigma);
  s.accel_sigma = std::sqrt(s.accel_sigma);
  return s;
}

// Roll and pitch that put `up_base` along z, with yaw 0 in the sense of SE3::rpy.
Quat level(const Vec3& up_base) {
  const double roll = std::atan2(up_base.y(), up_base.z());
  const double pitch = std::atan2(-up_base.x(), std::hypot(up_base.y(), up_base.z()));
  return SE3::from_rpy({roll, pitch, 0}, Vec3::Zero()).rotation;
}

}  // namespace

RestAlignment align_at_rest(const std::deque<ImuSample>& samples, const ImuCalibration& imu,
                            const InertialConfig& config) {
  RestAlignment result;
  if (samples.empty()) return result;
  constexpr size_t kEnough = 5;
  constexpr double kMostBias_radps = 0.1;  // a phone's, twice; or a slow turn
  constexpr double kLeast = 0.7, kMost = 1.3;  // of gravity: no robot drives with 7 m/s^2
  const Spread spread = spread_of(samples);
  result.at_rest = samples.size() >= kEnough && spread.gyro_sigma < config.rest_gyro_radps &&
                   spread.accel_sigma < config.rest_accel_mps2 &&
                   spread.gyro_mean.norm() < kMostBias_radps;
  const Quat& q_base_imu = imu.T_base_imu.rotation;
  const double force = spread.accel_mean.norm() / imu.gravity_mps2;
  result.no_gravity = samples.size() >= kEnough && !(force > kLeast && force < kMost);
  result.upside_down = samples.size() >= kEnough && !result.no_gravity && (q_base_imu * spread.accel_mean).z() < 0;
  if (result.no_gravity || result.upside_down) return result;
  result.at_rest = result.at_rest && std::abs(force - 1) * imu.gravity_mps2 < 2.0 * config.rest_accel_mps2;
  if (result.at_rest) {
    result.gyro_bias_radps = spread.gyro_mean;
    constexpr double kTurnShare = 0.1;  // it may be a turn after all, which the scans will tell
    const double sample_sigma = imu.gyro_noise_radps_rthz * std::sqrt(imu.rate_hz);
    result.gyro_bias_sigma_radps = std::max(sample_sigma / std::sqrt(static_cast<double>(samples.size())),
                                            kTurnShare * spread.gyro_mean.norm());
    result.accel_bias_mps2 = spread.accel_mean - imu.gravity_mps2 * spread.accel_mean.normalized();
  }
  const auto& q_earth_imu = samples.front().q_earth_imu;
  if (!result.at_rest && q_earth_imu)
    result.q_odom_base = level(q_base_imu * (q_earth_imu->conjugate() * Vec3::UnitZ()));
  else if (spread.accel_mean.norm() > 0.1 * imu.gravity_mps2)
    result.q_odom_base = level(q_base_imu * spread.accel_mean);
  return result;
}

}  // namespace vsslam

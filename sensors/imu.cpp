#include "sensors/imu.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vsslam {

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

Vec3 three_normals(const RandomStream& stream, uint64_t counter) {
  return {stream.normal(counter, 0), stream.normal(counter, 1), stream.normal(counter, 2)};
}

Vec3 limit(const Vec3& value, double range, double step) {
  Vec3 out = value;
  for (int i = 0; i < 3; ++i) {
    if (range > 0) out[i] = std::clamp(out[i], -range, range);
    if (step > 0) out[i] = std::round(out[i] / step) * step;
  }
  return out;
}

}  // namespace

void ImuConfig::fields(Fields& f) {
  f("rate_hz", rate_hz, between(1, 4000));
  f("gyro_noise_radps_rthz", gyro_noise_radps_rthz, non_negative());
  f("accel_noise_mps2_rthz", accel_noise_mps2_rthz, non_negative());
  f("gyro_bias_walk_radps2_rthz", gyro_bias_walk_radps2_rthz, non_negative());
  f("accel_bias_walk_mps3_rthz", accel_bias_walk_mps3_rthz, non_negative());
  f("gyro_turn_on_bias_radps", gyro_turn_on_bias_radps, non_negative());
  f("accel_turn_on_bias_mps2", accel_turn_on_bias_mps2, non_negative());
  f("gyro_g_sensitivity_rads", gyro_g_sensitivity_rads, non_negative());
  f("gyro_range_radps", gyro_range_radps, non_negative());
  f("accel_range_mps2", accel_range_mps2, non_negative());
  f("gyro_step_radps", gyro_step_radps, non_negative());
  f("accel_step_mps2", accel_step_mps2, non_negative());
  f("orientation", orientation);
  f("roll_pitch_sigma_deg", roll_pitch_sigma_deg, between(0, 90));
  f("heading_sigma_deg", heading_sigma_deg, between(0, 180));
  f("orientation_time_s", orientation_time_s, positive());
  f("vibration_rms_mps2", vibration_rms_mps2, non_negative());
  f("vibration_hz", vibration_hz, positive());
}

ImuConfig ImuConfig::ideal(double rate_hz) {
  ImuConfig config;
  config.rate_hz = rate_hz;
  config.gyro_noise_radps_rthz = config.accel_noise_mps2_rthz = 0;
  config.gyro_bias_walk_radps2_rthz = config.accel_bias_walk_mps3_rthz = 0;
  config.gyro_turn_on_bias_radps = config.accel_turn_on_bias_mps2 = 0;
  config.gyro_g_sensitivity_rads = config.gyro_range_radps = config.accel_range_mps2 = 0;
  config.roll_pitch_sigma_deg = config.heading_sigma_deg = 0;
  return config;
}

// a_imu = a + alpha x r + omega x (omega x r); specific force f = R^T (a_imu - g).
InertialTruth feel(const Kinematics& motion, const SE3& T_base_imu, double gravity_mps2) {
  const Vec3& r_base = T_base_imu.translation;
  const Vec3& omega = motion.omega_base;
  const Vec3 lever_base = motion.alpha_base.cross(r_base) + omega.cross(omega.cross(r_base));
  const Vec3 free_world = motion.a_world + gravity_mps2 * Vec3::UnitZ();
  const Vec3 force_base = motion.T_world_base.rotation.conjugate() * free_world + lever_base;
  const Quat q_imu_base = T_base_imu.rotation.conjugate();
  return {q_imu_base * omega, q_imu_base * force_base};
}

Imu::Imu(const ImuConfig& config, const SE3& T_base_imu, uint64_t seed)
    : config_(config),
      T_base_imu_(T_base_imu),
      gyro_noise_(seed, "imu.gyro"),
      accel_noise_(seed, "imu.accel"),
      gyro_walk_(seed, "imu.gyro_walk"),
      accel_walk_(seed, "imu.accel_walk"),
      vibration_phase_(seed, "imu.vibration"),
      orientation_noise_(RandomStream(seed, "imu.orientation"), config.orientation_time_s),
      gyro_turn_on_(config.gyro_turn_on_bias_radps *
                    three_normals(RandomStream(seed, "imu.gyro_turn_on"), 0)),
      accel_turn_on_(config.accel_turn_on_bias_mps2 *
                     three_normals(RandomStream(seed, "imu.accel_turn_on"), 0)) {}

Time Imu::stamp(int64_t index) const {
  return Time{std::llround(static_cast<double>(index) * (1e9 / config_.rate_hz))};
}

int64_t Imu::first_index(Time at_or_after) const {
  auto index = static_cast<int64_t>(std::floor(at_or_after.seconds() * config_.rate_hz)) - 1;
  while (stamp(index) < at_or_after) ++index;
  return index;
}

void Imu::walk_biases(int64_t index) {
  const double step = std::sqrt(1 / config_.rate_hz);
  for (; walked_until_ < index; ++walked_until_) {
    const auto counter = static_cast<uint64_t>(walked_until_);
    gyro_walked_ += config_.gyro_bias_walk_radps2_rthz * step * three_normals(gyro_walk_, counter);
    accel_walked_ += config_.accel_bias_walk_mps3_rthz * step * three_normals(accel_walk_, counter);
  }
}

// One tone with a phase per axis that wanders over a second, so that it is a line of finite width.
Vec3 Imu::vibration(Time stamp) const {
  if (config_.vibration_rms_mps2 == 0) return Vec3::Zero();
  const SlowNoise wander(vibration_phase_, 1.0);
  const double turns = stamp.seconds() * config_.vibration_hz;
  Vec3 a;
  for (int axis = 0; axis < 3; ++axis) {
    const double phase = 2 * std::numbers::pi * (turns - std::floor(turns)) +
                         std::numbers::pi * wander.at(stamp.seconds(), static_cast<uint64_t>(axis));
    a[axis] = config_.vibration_rms_mps2 * std::numbers::sqrt2 * std::sin(phase);
  }
  return a;
}

Quat Imu::orientation(const SE3& T_world_imu, Time stamp) const {
  const double t = stamp.seconds();
  const double tilt = config_.roll_pitch_sigma_deg * kRadPerDeg,
               turn = config_.heading_sigma_deg * kRadPerDeg;
  Vec3 error_earth = Vec3::Zero();
  if (tilt > 0)
    error_earth.head<2>() << tilt * orientation_noise_.at(t, 0), tilt * orientation_noise_.at(t, 1);
  if (turn > 0) error_earth.z() = turn * orientation_noise_.at(t, 2);
  return (so3_exp(error_earth) * T_world_imu.rotation).normalized();
}

ImuMeasurement Imu::measure(int64_t index, const Trajectory& trajectory) {
  const Time now = stamp(index);
  const auto counter = static_cast<uint64_t>(index);
  const Kinematics motion = trajectory.at(now);
  const InertialTruth truth = feel(motion, T_base_imu_);
  walk_biases(index);

  ImuMeasurement m;
  m.sample.stamp = m.true_stamp = now;
  m.true_gyro_radps = truth.gyro_radps;
  m.true_accel_mps2 = truth.accel_mps2;
  m.gyro_bias_radps = gyro_turn_on_ + gyro_walked_;
  m.accel_bias_mps2 = accel_turn_on_ + accel_walked_;

  const double per_sample = std::sqrt(config_.rate_hz);
  const Vec3 accel = truth.accel_mps2 + vibration(now);
  const Vec3 gyro_noise = config_.gyro_noise_radps_rthz * per_sample * three_normals(gyro_noise_, counter);
  const Vec3 accel_noise = config_.accel_noise_mps2_rthz * per_sample * three_normals(accel_noise_, counter);
  const Vec3 gyro =
      truth.gyro_radps + config_.gyro_g_sensitivity_rads * accel + m.gyro_bias_radps + gyro_noise;
  m.sample.gyro_radps = limit(gyro, config_.gyro_range_radps, config_.gyro_step_radps);
  m.sample.accel_mps2 =
      limit(accel + m.accel_bias_mps2 + accel_noise, config_.accel_range_mps2, config_.accel_step_mps2);
  if (config_.orientation) m.sample.q_earth_imu = orientation(motion.T_world_base * T_base_imu_, now);
  return m;
}

}  // namespace vsslam

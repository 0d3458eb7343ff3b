// An inertial measurement unit: what the truth's kinematics feel like at its mount, and its errors.
//
// Frame `imu`: x forward, y left, z up when mounted level. At rest it reads +g along the axis that points up.
#pragma once

#include <cstdint>

#include "core/config.h"
#include "core/rng.h"
#include "sensors/measurement/noise.h"
#include "sensors/measurement/samples.h"
#include "sim/trajectory.h"

namespace vsslam {

/// Defaults: Xsens MTi-300. Each error has its own switch: 0 turns it off and leaves the others as they were.
struct ImuConfig {
  double rate_hz = 100;
  double gyro_noise_radps_rthz = 1.745e-4;  ///< white: sigma of a sample = density * sqrt(rate)
  double accel_noise_mps2_rthz = 5.88e-4;
  double gyro_bias_walk_radps2_rthz = 1e-5;  ///< random walk: sigma of a step = density * sqrt(period)
  double accel_bias_walk_mps3_rthz = 1e-4;
  double gyro_turn_on_bias_radps = 0.002;  ///< sigma per axis, constant over a run
  double accel_turn_on_bias_mps2 = 0.02;
  double gyro_g_sensitivity_rads = 5.34e-6;  ///< rad/s per m/s^2 of specific force along the same axis
  double gyro_range_radps = 7.854;           ///< saturation; 0: unlimited
  double accel_range_mps2 = 196.1;
  double gyro_step_radps = 0, accel_step_mps2 = 0;  ///< quantisation; 0: none

  bool orientation = true;            ///< the device delivers its own orientation
  double roll_pitch_sigma_deg = 0.2;  ///< error of it, changing slowly
  double heading_sigma_deg = 1.0;
  double orientation_time_s = 30;  ///< how slowly

  double vibration_rms_mps2 = 0;  ///< per axis, of the mount
  double vibration_hz = 35;

  void fields(Fields& f);
  static ImuConfig ideal(double rate_hz);
};

/// Noise-free angular rate and specific force at the mount, in the imu frame.
struct InertialTruth {
  Vec3 gyro_radps, accel_mps2;
};
InertialTruth feel(const Kinematics& motion, const SE3& T_base_imu, double gravity_mps2 = 9.80665);

/// Samples in order of time; the only state is the sum of the bias steps so far.
class Imu {
 public:
  Imu(const ImuConfig& config, const SE3& T_base_imu, uint64_t seed);

  Time stamp(int64_t index) const;  ///< of sample 0, 1, 2, ...
  int64_t first_index(Time at_or_after) const;
  /// The sample of that index; indices must not fall from call to call.
  ImuMeasurement measure(int64_t index, const Trajectory& trajectory);

 private:
  void walk_biases(int64_t index);
  Vec3 vibration(Time stamp) const;
  Quat orientation(const SE3& T_world_imu, Time stamp) const;

  ImuConfig config_;
  SE3 T_base_imu_;
  RandomStream gyro_noise_, accel_noise_, gyro_walk_, accel_walk_, vibration_phase_;
  SlowNoise orientation_noise_;
  Vec3 gyro_turn_on_, accel_turn_on_;
  Vec3 gyro_walked_ = Vec3::Zero(), accel_walked_ = Vec3::Zero();
  int64_t walked_until_ = 0;
};

}  // namespace vsslam

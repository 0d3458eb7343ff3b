#include "slam/inertial/motion_prior.h"

#include "slam/inertial/dead_reckoning.h"
#include "slam/inertial/imu_prior.h"

namespace vsslam {

void InertialConfig::fields(Fields& f) {
  f("rest_gyro_radps", rest_gyro_radps, positive());
  f("rest_accel_mps2", rest_accel_mps2, positive());
  f("spike_gyro_radps", spike_gyro_radps, positive());
  f("spike_accel_mps2", spike_accel_mps2, positive());
  f("max_gap_s", max_gap_s, positive());
  f("max_speed_mps", max_speed_mps, positive());
  f("max_turn_radps", max_turn_radps, positive());
  f("unknown_accel_mps2", unknown_accel_mps2, positive());
  f("unknown_turn_radps2", unknown_turn_radps2, positive());
  f.automatic("imu_noise_factor", imu_noise_factor, positive());
  f("gyro_scale_sigma", gyro_scale_sigma, non_negative());
  f("accel_bias_sigma_mps2", accel_bias_sigma_mps2, positive());
  f("wheel_slip", wheel_slip, positive());
  f("wheel_turn_slip", wheel_turn_slip, positive());
}

std::unique_ptr<MotionPrior> make_motion_prior(PriorKind kind, const InertialConfig& config,
                                               const RigCalibration& rig) {
  const bool wheels = kind == PriorKind::wheel_imu || kind == PriorKind::wheel;
  if (kind == PriorKind::imu || kind == PriorKind::wheel_imu) return std::make_unique<ImuPrior>(config, rig, wheels);
  return std::make_unique<DeadReckoning>(config, rig, wheels);
}

}  // namespace vsslam

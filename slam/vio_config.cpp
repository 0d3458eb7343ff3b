#include "slam/vio/vio.h"

namespace vsslam {

void VioRestConfig::fields(Fields& f) {
  f("window_s", window_s, between(0.1, 2));
  f("gyro_radps", gyro_radps, positive());
  f("accel_mps2", accel_mps2, positive());
  f("gyro_change_radps", gyro_change_radps, positive());
  f("accel_change_mps2", accel_change_mps2, positive());
  f("flow_px", flow_px, positive());
  f("speed_mps", speed_mps, positive());
}

void VioStartConfig::fields(Fields& f) {
  f("max_aid_age_s", max_aid_age_s, positive());
  f("aid_tilt_sigma_rad", aid_tilt_sigma_rad, positive());
  f("aid_velocity_sigma_mps", aid_velocity_sigma_mps, positive());
  f("gyro_bias_sigma_radps", gyro_bias_sigma_radps, positive());
  f("accel_bias_sigma_mps2", accel_bias_sigma_mps2, positive());
  f("motion_s", motion_s, positive());
  f("motion_velocity_sigma", motion_velocity_sigma, positive());
}

void VioLimits::fields(Fields& f) {
  f("min_tracks", min_tracks, at_least(0));
  f("blind_s", blind_s, non_negative());
  f("gyro_bias_radps", gyro_bias_radps, positive());
  f("accel_bias_mps2", accel_bias_mps2, positive());
  f("speed_mps", speed_mps, positive());
  f("jump_m", jump_m, positive());
  f("jump_rad", jump_rad, positive());
}

void VioConfig::fields(Fields& f) {
  f("window", window, between(3, 100));
  f("max_rate_hz", max_rate_hz, positive());
  f("time_offset_s", time_offset_s, between(-1, 1));
  f("feature_sigma_px", feature_sigma_px, positive());
  f("depth_sigma_ratio", depth_sigma_ratio, positive());
  f("imu_noise_factor", imu_noise_factor, positive());
  f("key_parallax_px", key_parallax_px, positive());
  f("key_tracks", key_tracks, at_least(0));
  f("key_interval_s", key_interval_s, positive());
  f("max_features", max_features, between(10, 2000));
  f("outlier_px", outlier_px, positive());
  f("max_iterations", max_iterations, between(1, 1000));
  f("rest", rest);
  f("start", start);
  f("limits", limits);
}

}  // namespace vsslam

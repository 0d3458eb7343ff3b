#include "sensors/lidar/lidar_config.h"

namespace vsslam {

void LidarConfig::fields(Fields& f) {
  f.choice("model", model, {{"vlp16", LidarModel::vlp16}, {"vlp32c", LidarModel::vlp32c}});
  f("rate_hz", rate_hz, between(5, 20));
  f.choice("return_mode", return_mode, {{"strongest", ReturnMode::strongest}, {"last", ReturnMode::last}});
  f("min_range_m", min_range_m, at_least(0.1));
  f("max_range_m", max_range_m, between(1, 1000));
  f.check(max_range_m > min_range_m, "max_range_m", "more than min_range_m");
  f("range_step_m", range_step_m, between(0, 0.1));
  f("pose_per_firing", pose_per_firing);
  f("range_sigma_m", range_sigma_m, between(0, 1));
  f("laser_bias_sigma_m", laser_bias_sigma_m, between(0, 1));
  f("incidence_bias_scale", incidence_bias_scale, between(0, 10));
  f("intensity_sigma", intensity_sigma, between(0, 50));
  f("azimuth_step_deg", azimuth_step_deg, between(0, 1));
  f("azimuth_jitter_sigma_deg", azimuth_jitter_sigma_deg, between(0, 0.1));
  f("rotation_wander_sigma_deg", rotation_wander_sigma_deg, between(0, 1));
  f("rotation_wander_time_s", rotation_wander_time_s, between(0.01, 10));
  f("dropout", dropout);
  f("detection_range_m", detection_range_m, positive());
  f("detection_sigma", detection_sigma, between(0, 0.2));
  f("sub_rays", sub_rays, between(1, 37));
  f("divergence_horizontal_mrad", divergence_horizontal_mrad, between(0, 20));
  f("divergence_vertical_mrad", divergence_vertical_mrad, between(0, 20));
  f("pulse_length_ns", pulse_length_ns, between(0, 100));
}

LidarConfig LidarConfig::ideal(LidarModel model) {
  LidarConfig config;
  config.model = model;
  config.range_step_m = 0;
  config.range_sigma_m = config.laser_bias_sigma_m = config.incidence_bias_scale = config.intensity_sigma = 0;
  config.azimuth_step_deg = config.azimuth_jitter_sigma_deg = config.rotation_wander_sigma_deg = 0;
  config.dropout = false;
  return config;
}

}  // namespace vsslam

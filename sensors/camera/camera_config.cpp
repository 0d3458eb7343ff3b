#include "sensors/camera/camera_config.h"

namespace vsslam {

void AutoExposureConfig::fields(Fields& f) {
  f("enabled", enabled);
  f("target_grey", target_grey, between(1, 254));
  f("min_exposure_s", min_exposure_s, positive());
  f("max_exposure_s", max_exposure_s, positive());
  f("min_gain", min_gain, positive());
  f("max_gain", max_gain, positive());
  f("share_per_frame", share_per_frame, between(0.01, 1));
  f("delay_frames", delay_frames, between(1, 30));
  f.check(max_exposure_s >= min_exposure_s, "max_exposure_s", "min_exposure_s or more");
  f.check(max_gain >= min_gain, "max_gain", "min_gain or more");
}

void CameraTruthConfig::fields(Fields& f) {
  f("clean", clean);
  f("depth", depth);
  f("flow", flow);
}

void CameraConfig::fields(Fields& f) {
  f("enabled", enabled);
  f("width_px", width_px, between(16, 8192));
  f("height_px", height_px, between(16, 8192));
  f("rate_hz", rate_hz, between(0.1, 1000));
  f("phase_s", phase_s, between(0, 10));
  f("fx_px", fx_px, positive());
  f("fy_px", fy_px, positive());
  f("cx_px", cx_px);
  f("cy_px", cy_px);
  f("k1", k1);
  f("k2", k2);
  f("p1", p1);
  f("p2", p2);
  f("exposure_s", exposure_s, positive());
  f("gain", gain, positive());
  f("auto_exposure", auto_exposure);
  f("motion_blur", motion_blur);
  f("blur_spacing_px", blur_spacing_px, positive());
  f("blur_view_spacing_px", blur_view_spacing_px, positive());
  f("max_blur_views", max_blur_views, between(1, 64));
  f("samples_per_pixel", samples_per_pixel, between(1, 64));
  f("sensitivity_e_per_cdm2_ms", sensitivity_e_per_cdm2_ms, positive());
  f("full_well_e", full_well_e, positive());
  f("vignetting_exponent", vignetting_exponent, between(0, 16));
  f("shot_noise", shot_noise);
  f("read_noise_e", read_noise_e, non_negative());
  f("fixed_gain_sigma", fixed_gain_sigma, between(0, 0.2));
  f("fixed_offset_e", fixed_offset_e, non_negative());
  f("gamma", gamma, between(0.2, 5));
  f("truth", truth);
  f.check(width_px % 4 == 0, "width_px", "a multiple of 4");
  f.check(height_px % 4 == 0, "height_px", "a multiple of 4");
  const double longest_s = auto_exposure.enabled ? auto_exposure.max_exposure_s : exposure_s;
  f.check(longest_s <= 0.9 / rate_hz, auto_exposure.enabled ? "auto_exposure" : "exposure_s",
          "an exposure within 0.9 of the time between images");
}

CameraConfig CameraConfig::ideal() {
  CameraConfig config;
  config.enabled = true;
  config.auto_exposure.enabled = config.motion_blur = config.shot_noise = false;
  config.vignetting_exponent = config.read_noise_e = config.fixed_gain_sigma = config.fixed_offset_e = 0;
  return config;
}

}  // namespace vsslam

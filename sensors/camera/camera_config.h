// Settings of a camera. Every effect has its own switch (false or 0 turns it off) and its own random numbers, so that
// switching one off leaves all others as they were.
#pragma once

#include "core/config.h"

namespace vsslam {

/// Steers exposure time and gain so that the mean grey of the image meets a target.
struct AutoExposureConfig {
  bool enabled = true;
  double target_grey = 110;                              ///< mean of the image, 0..255
  double min_exposure_s = 5e-5, max_exposure_s = 0.003;  ///< exposure goes first; the cap limits blur
  double min_gain = 1, max_gain = 16;                    ///< gain does the rest
  double share_per_frame = 0.3;                          ///< of the (logarithmic) way to go, 1: at once
  int delay_frames = 3;  ///< from measuring an image to the first that it changes
  void fields(Fields& f);
};

/// What is delivered beside the image, for evaluation; each costs time and memory.
struct CameraTruthConfig {
  bool clean = false;  ///< the image without blur, noise and quantisation
  bool depth = false;
  bool flow = false;
  bool any() const { return clean || depth || flow; }
  void fields(Fields& f);
};

/// Defaults: left infrared camera of a D435i as a grey camera (3 um pixels behind f/2, rectified), exposure capped at
/// 3 ms as on a moving robot.
struct CameraConfig {
  bool enabled = false;
  int width_px = 640, height_px = 480;  ///< multiples of 4
  double rate_hz = 30;
  double phase_s = 0;  ///< of the images' stamps against time 0
  // Pinhole; pixel centres have whole coordinates.
  double fx_px = 384.2, fy_px = 384.2, cx_px = 319.5, cy_px = 236.4;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;  ///< radial-tangential distortion, OpenCV's order

  double exposure_s = 0.003, gain = 12;  ///< fixed, or where auto exposure begins
  AutoExposureConfig auto_exposure;
  bool motion_blur = true;
  double blur_spacing_px = 1;       ///< largest flow between the instants that are averaged
  double blur_view_spacing_px = 4;  ///< between those that are rendered, in 95 % of the image
  int max_blur_views = 8;           ///< rendered at most
  int samples_per_pixel = 1;        ///< rays that share a pixel's area: smoother edges at a price in time

  double sensitivity_e_per_cdm2_ms = 9;  ///< electrons of a pixel on the axis that sees 1 cd/m^2 for 1 ms
  double full_well_e = 6500;             ///< electrons that a pixel holds, and of grey 255 at gain 1
  double vignetting_exponent = 4;        ///< cos^n of the angle to the axis
  bool shot_noise = true;                ///< variance = signal, in electrons
  double read_noise_e = 5;               ///< white, per pixel and image
  double fixed_gain_sigma = 0.01;        ///< of the pixels' gains, relative; fixed per seed
  double fixed_offset_e = 2;             ///< sigma of the pixels' offsets; fixed per seed
  double gamma = 1;                      ///< grey = 255 * signal^(1/gamma); 1: linear

  CameraTruthConfig truth;

  void fields(Fields& f);
  /// Enabled, with geometry, timing and fixed exposure of the default, and no other effect.
  static CameraConfig ideal();
};

}  // namespace vsslam

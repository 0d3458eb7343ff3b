// From luminance to grey values: electrons, their noise, the pixels' differences, response and quantisation (the model
// of EMVA 1288). For a pixel that sees luminance L (cd/m^2) for t (ms) at an angle a to the axis:
//
//   s = sensitivity * L * t * cos^n(a)                                     signal, electrons
//   e = s (1 + fixed_gain_sigma z_gain) + fixed_offset z_offset            fixed pattern: z per pixel and seed
//       + sqrt(signal of this pixel) z_shot + read_noise z_read            z per pixel and image
//   grey = round(255 * min(1, gain * clamp(e, 0, full_well) / full_well)^(1/gamma))
//
// Shot noise is normal instead of Poisson: below some 10 electrons its skewness is missing.
#pragma once

#include <span>
#include <vector>

#include "core/rng.h"
#include "sensors/camera/camera_config.h"
#include "sensors/camera/camera_exposure.h"

namespace vsslam {

class ImageSensor {
 public:
  /// `cos_axis`: per pixel, cosine of the angle between its ray and the optical axis; a multiple of 16 pixels.
  ImageSensor(const CameraConfig& config, std::span<const float> cos_axis, uint64_t seed);

  /// Image number `image` of this luminance, row-major; returns its mean grey. Thread-safe.
  double expose(std::span<const float> luminance, const Exposure& exposure, uint64_t image,
                std::span<uint8_t> grey) const;
  /// The same without noise, fixed pattern and quantisation: 0 .. 255.
  void expose_clean(std::span<const float> luminance, const Exposure& exposure, std::span<float> grey) const;

 private:
  float electrons_per_cdm2(const Exposure& exposure) const;
  void make_fixed_pattern(uint64_t seed);
  void make_response();

  CameraConfig config_;
  RandomStream shot_, read_;
  std::vector<float> vignetting_;  ///< per pixel
  std::vector<float> gain_;        ///< per pixel: vignetting and fixed pattern
  std::vector<float> offset_e_;    ///< per pixel; empty: none
  static constexpr size_t kResponseLevels = 65536;
  std::vector<uint8_t> response_;  ///< grey of each level; empty: linear
};

}  // namespace vsslam

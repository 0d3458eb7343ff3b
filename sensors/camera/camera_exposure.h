// How long and at which gain images are exposed.
//
// Auto exposure works with the product of exposure time and gain, E (in s). An image of mean grey g taken at E wishes
// for E * (target / g)^gamma, which does not depend on E itself unless the image is saturated or black. The setting of
// image n follows the wish of image n - delay by a share of the way, in logarithms:
//   log E_n = log E_{n-1} + share * (log wish_{n-delay} - log E_{n-1}),
// a first-order lag with a dead time, so that it cannot oscillate. Saturation and noise make wishes too timid, never too
// bold. Because of the delay, the settings of the next `delay` images are always known, and these may be taken side by
// side.
#pragma once

#include <cstdint>
#include <deque>

#include "core/time.h"
#include "sensors/camera/camera_config.h"

namespace vsslam {

struct Exposure {
  Duration time;  ///< an even number of ns, so that its middle is exact
  double gain = 1;
  double product_s() const { return time.seconds() * gain; }
};

class ExposureControl {
 public:
  explicit ExposureControl(const CameraConfig& config);
  /// Of the k-th image after the last one that was reported, k = 0 .. known() - 1.
  const Exposure& ahead(int k) const { return settings_[static_cast<size_t>(k)]; }
  int known() const { return static_cast<int>(settings_.size()); }
  /// The next image came out with this mean grey; in order.
  void saw(double mean_grey);
  /// The next image was not taken.
  void missed();

 private:
  Exposure clamped(double product_s) const;
  void push(double product_s);

  AutoExposureConfig config_;
  double gamma_;
  double product_s_;               ///< of the last setting, not rounded
  std::deque<Exposure> settings_;  ///< of the images to come
};

}  // namespace vsslam

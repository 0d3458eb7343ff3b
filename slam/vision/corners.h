// Corners that a small window can be tracked by (Shi & Tomasi, CVPR 1994), spread over the image, looked for only
// where there is room.
#pragma once

#include <vector>

#include "core/config.h"
#include "slam/vision/grey_view.h"

namespace vsslam {

struct CornerConfig {
  double min_distance_px = 24.0;  ///< between features
  double quality = 0.001;  ///< smallest response, as a share of the strongest corner's in view. The published
                           ///< 0.01 lets one lamp in view hide all texture
  double min_gradient_grey = 0.7;  ///< per pixel, in the weaker direction: what is fainter is not a corner
  double noise_factor = 0.3;  ///< the same in units of the noise, for an image smoothed by a Gaussian of 1 px
  double cell_px = 80.0;  ///< corners are spread over cells of this size: the poorest cell is served first
  int border_px = 12;     ///< no corner nearer to the edge of the image
  void fields(Fields& f);
};

/// At most `wanted` corners, whole pixels, each at least the minimum distance from the others and from `taken`.
/// `noise_grey`: standard deviation of the noise, before smoothing.
std::vector<Eigen::Vector2f> find_corners(const GreyView& image, double noise_grey,
                                          const std::vector<Eigen::Vector2f>& taken, size_t wanted,
                                          const CornerConfig& config);

}  // namespace vsslam

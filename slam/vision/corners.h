// Corners that a small window can be tracked by (Shi & Tomasi, CVPR 1994), looked for only where there is room.
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.h"

namespace vsslam {

/// An image in somebody else's memory, 8 bits.
struct GreyView {
  const uint8_t* pixels = nullptr;
  int width_px = 0, height_px = 0;
  ptrdiff_t stride = 0;  ///< bytes from row to row

  const uint8_t* row(int y) const { return pixels + y * stride; }
};

struct CornerConfig {
  double min_distance_px = 24.0;   ///< between features
  double quality = 0.01;           ///< smallest response, as a share of the strongest corner's in view
  double min_gradient_grey = 1.5;  ///< per pixel, in the weaker direction: what is fainter is not a corner
  double noise_factor = 1.5;       ///< the same in units of the image's own noise
  double cell_px = 80.0;  ///< corners are spread over cells of this size: the poorest cell is served first
  int border_px = 12;     ///< no corner nearer to the edge of the image
  void fields(Fields& f);
};

/// Standard deviation of the grey values' noise (Immerkaer, CVIU 1996; with the median in place of the mean, so
/// that texture does not count as noise).
double noise_sigma_grey(const GreyView& image);

/// Smaller eigenvalue of the mean structure tensor of the 5 x 5 pixels around (x, y), in (grey / px)^2.
float corner_response(const GreyView& image, int x, int y);

/// How the flow of a window answers when its content is not only shifted but warped: content at x about the
/// centre moves by d + W x, and the flow that fits the window best is d + by_x W.col(0) + by_y W.col(1), where
/// by_x = (sum g g')^-1 sum x g g' over its gradients g. Left alone, zoom and rotation between images shift a
/// track by a few hundredths of a pixel in each, always the same way.
struct WindowShape {
  Eigen::Matrix2f by_x = Eigen::Matrix2f::Zero(), by_y = Eigen::Matrix2f::Zero();  ///< px

  Eigen::Vector2f flow_of(const Eigen::Matrix2f& warp) const {
    return by_x * warp.col(0) + by_y * warp.col(1);
  }
  /// The point that moves as the flow says under zoom, from the window's centre: where the lines across its
  /// gradients meet best (Foerstner & Guelch 1987).
  Eigen::Vector2f centre_px() const { return by_x.col(0) + by_y.col(1); }
};
WindowShape window_shape(const GreyView& image, int x, int y, int window_px);

/// At most `wanted` corners, whole pixels, each at least the minimum distance from the others and from `taken`.
std::vector<Eigen::Vector2f> find_corners(const GreyView& image, const std::vector<Eigen::Vector2f>& taken,
                                          size_t wanted, const CornerConfig& config);

}  // namespace vsslam

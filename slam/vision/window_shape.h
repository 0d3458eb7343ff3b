// What Lucas-Kanade measures when the content of its window does not only shift.
#pragma once

#include <Eigen/Core>

#include "slam/vision/grey_view.h"

namespace vsslam {

struct WindowSize {
  int width_px, height_px;
};

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
WindowShape window_shape(const GreyView& image, int x, int y, const WindowSize& window);

}  // namespace vsslam

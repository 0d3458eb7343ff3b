#include "slam/vision/window_shape.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstdlib>

namespace vsslam {

namespace {

/// Of a pixel at `offset` from the centre. An even number of pixels ends amid the outermost ones.
double share_in_window(int offset, int size_px) {
  return 2 * std::abs(offset) == size_px ? 0.5 : 1;
}

}  // namespace

WindowShape window_shape(const GreyView& image, int x, int y, const WindowSize& window) {
  const int reach_x = std::min({window.width_px / 2, x - 1, image.width_px - 2 - x}),
            reach_y = std::min({window.height_px / 2, y - 1, image.height_px - 2 - y});
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero(), sum_x = sum, sum_y = sum;
  for (int v = -reach_y; v <= reach_y; ++v) {
    const uint8_t *a = image.row(y + v - 1) + x, *b = image.row(y + v) + x, *c = image.row(y + v + 1) + x;
    for (int u = -reach_x; u <= reach_x; ++u) {  // Scharr's gradient, which Lucas-Kanade uses
      const double dx = 3 * (a[u + 1] - a[u - 1] + c[u + 1] - c[u - 1]) + 10 * (b[u + 1] - b[u - 1]);
      const double dy = 3 * (c[u - 1] - a[u - 1] + c[u + 1] - a[u + 1]) + 10 * (c[u] - a[u]);
      const double share = share_in_window(u, window.width_px) * share_in_window(v, window.height_px);
      const Eigen::Matrix2d tensor{{share * dx * dx, share * dx * dy}, {share * dx * dy, share * dy * dy}};
      sum += tensor;
      sum_x += u * tensor;
      sum_y += v * tensor;
    }
  }
  if (sum.determinant() <= 1e-6 * sum.trace() * sum.trace()) return {};
  const Eigen::Matrix2d inverse = sum.inverse();
  WindowShape shape{(inverse * sum_x).cast<float>(), (inverse * sum_y).cast<float>()};
  const Eigen::Vector2f reach(static_cast<float>(reach_x), static_cast<float>(reach_y));
  return (shape.centre_px().cwiseAbs().array() > reach.array()).any() ? WindowShape{} : shape;
}

}  // namespace vsslam

#include "slam/vision/window_shape.h"

#include <Eigen/LU>
#include <algorithm>

namespace vsslam {

WindowShape window_shape(const GreyView& image, int x, int y, int window_px) {
  const int reach = std::min({window_px / 2, x - 1, y - 1, image.width_px - 2 - x, image.height_px - 2 - y});
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero(), sum_x = sum, sum_y = sum;
  for (int v = -reach; v <= reach; ++v) {
    const uint8_t *a = image.row(y + v - 1) + x, *b = image.row(y + v) + x, *c = image.row(y + v + 1) + x;
    for (int u = -reach; u <= reach; ++u) {  // Scharr's gradient, which Lucas-Kanade uses
      const double dx = 3 * (a[u + 1] - a[u - 1] + c[u + 1] - c[u - 1]) + 10 * (b[u + 1] - b[u - 1]);
      const double dy = 3 * (c[u - 1] - a[u - 1] + c[u + 1] - a[u + 1]) + 10 * (c[u] - a[u]);
      const Eigen::Matrix2d tensor{{dx * dx, dx * dy}, {dx * dy, dy * dy}};
      sum += tensor;
      sum_x += u * tensor;
      sum_y += v * tensor;
    }
  }
  if (sum.determinant() <= 1e-6 * sum.trace() * sum.trace()) return {};
  const Eigen::Matrix2d inverse = sum.inverse();
  WindowShape shape{(inverse * sum_x).cast<float>(), (inverse * sum_y).cast<float>()};
  return shape.centre_px().cwiseAbs().maxCoeff() > static_cast<float>(reach) ? WindowShape{} : shape;
}

}  // namespace vsslam

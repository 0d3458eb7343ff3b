#include "sensors/camera/camera_blur.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

struct Image {
  const float* pixels;
  int width, height;

  float at(float x, float y) const {
    const float inside_x = std::clamp(x, 0.0f, static_cast<float>(width - 1));
    const float inside_y = std::clamp(y, 0.0f, static_cast<float>(height - 1));
    const int left = std::min(static_cast<int>(inside_x), width - 2);
    const int top = std::min(static_cast<int>(inside_y), height - 2);
    const float across = inside_x - static_cast<float>(left), down = inside_y - static_cast<float>(top);
    const float* corner = pixels + static_cast<std::ptrdiff_t>(top) * width + left;
    const float upper = corner[0] + across * (corner[1] - corner[0]);
    const float lower = corner[width] + across * (corner[width + 1] - corner[width]);
    return upper + down * (lower - upper);
  }
};

float mean_along(const Image& image, float x, float y, const Vec2f& flow_px, int points) {
  const Vec2f step = flow_px / static_cast<float>(points);
  const float first = -0.5f * static_cast<float>(points - 1);
  float sum = 0;
  for (int k = 0; k < points; ++k) {
    const float steps = first + static_cast<float>(k);
    sum += image.at(x + steps * step.x(), y + steps * step.y());
  }
  return sum / static_cast<float>(points);
}

}  // namespace

void add_smeared(const View& view, int width_px, const std::vector<Vec2f>& flow_px, float spacing_px,
                 std::vector<float>& light) {
  constexpr float kMostPoints = 64;
  const Image image{view.luminance.data(), width_px, static_cast<int>(view.luminance.size()) / width_px};
  size_t i = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++i) {
      const float points = std::ceil(flow_px[i].norm() / spacing_px);
      if (points > 1 && std::isfinite(points))
        light[i] += mean_along(image, static_cast<float>(x), static_cast<float>(y), flow_px[i],
                               static_cast<int>(std::min(points, kMostPoints)));
      else
        light[i] += view.luminance[i];
    }
}

}  // namespace vsslam

#include "worlds/kit/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vsslam {

namespace {

float smooth(float t) {
  return t * t * (3 - 2 * t);
}
int wrapped(int i, int n) {
  return ((i % n) + n) % n;
}

// Adds one layer of value noise on a lattice of `nx` x `ny` cells.
void add_layer(std::vector<float>& sum, int width, int height, int nx, int ny, float weight, uint64_t layer,
               const RandomStream& stream) {
  std::vector<float> lattice(static_cast<size_t>(nx) * static_cast<size_t>(ny));
  for (size_t i = 0; i < lattice.size(); ++i)
    lattice[i] = weight * static_cast<float>(2 * stream.uniform(i, layer) - 1);
  std::vector<int> left(static_cast<size_t>(width)), right(left.size());
  std::vector<float> blend(left.size());
  for (int x = 0; x < width; ++x) {
    const float u = static_cast<float>(x) * static_cast<float>(nx) / static_cast<float>(width);
    const auto i = static_cast<size_t>(x);
    left[i] = static_cast<int>(u) % nx;
    right[i] = (left[i] + 1) % nx;
    blend[i] = smooth(u - std::floor(u));
  }
  for (int y = 0; y < height; ++y) {
    const float v = static_cast<float>(y) * static_cast<float>(ny) / static_cast<float>(height);
    const int row = static_cast<int>(v) % ny;
    const float* upper = &lattice[static_cast<size_t>(row) * static_cast<size_t>(nx)];
    const float* lower = &lattice[static_cast<size_t>((row + 1) % ny) * static_cast<size_t>(nx)];
    const float t = smooth(v - std::floor(v));
    float* out = &sum[static_cast<size_t>(y) * static_cast<size_t>(width)];
    for (size_t x = 0; x < left.size(); ++x) {
      const float a = upper[left[x]] + blend[x] * (upper[right[x]] - upper[left[x]]);
      const float b = lower[left[x]] + blend[x] * (lower[right[x]] - lower[left[x]]);
      out[x] += a + t * (b - a);
    }
  }
}

struct Glyph {
  char letter;
  std::array<uint8_t, 7> rows;  // 5 bits each, leftmost highest
};
constexpr Glyph kFont[] = {
    {'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
    {'2', {14, 17, 1, 6, 8, 16, 31}},    {'3', {31, 2, 4, 2, 1, 17, 14}},
    {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
    {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
    {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
    {'A', {14, 17, 17, 31, 17, 17, 17}}, {'B', {30, 17, 17, 30, 17, 17, 30}},
    {'E', {31, 16, 16, 30, 16, 16, 31}}, {'I', {14, 4, 4, 4, 4, 4, 14}},
    {'T', {31, 4, 4, 4, 4, 4, 4}},       {'X', {17, 17, 10, 4, 10, 17, 17}},
    {'R', {30, 17, 17, 30, 20, 18, 17}}, {'F', {31, 16, 16, 30, 16, 16, 16}},
};

}  // namespace

std::vector<float> tiling_noise(int width_px, int height_px, double cell_x_px, double cell_y_px, int octaves,
                                const RandomStream& stream) {
  std::vector<float> sum(static_cast<size_t>(width_px) * static_cast<size_t>(height_px), 0.0f);
  float weight = 1, total = 0;
  for (int k = 0; k < octaves; ++k, weight *= 0.6f) {
    const auto cells = [k](int size_px, double cell_px) {
      return std::clamp(static_cast<int>(std::lround(size_px / cell_px)) << k, 1, size_px);
    };
    add_layer(sum, width_px, height_px, cells(width_px, cell_x_px), cells(height_px, cell_y_px), weight,
              static_cast<uint64_t>(k), stream);
    total += weight;
  }
  for (float& value : sum) value *= 1.5f / total;
  return sum;
}

Canvas::Canvas(int width_px, int height_px, double px_per_m, uint64_t seed, std::string name)
    : width_(width_px),
      height_(height_px),
      px_per_m_(px_per_m),
      stream_(seed, name),
      name_(std::move(name)),
      pixels_(static_cast<size_t>(width_px) * static_cast<size_t>(height_px), Vec3f::Zero()) {}

void Canvas::fill(const Vec3f& color) {
  std::fill(pixels_.begin(), pixels_.end(), color);
}

void Canvas::grain(double cell_x_m, double cell_y_m, int octaves, float strength) {
  const RandomStream layer(stream_.bits(++layers_), "grain");
  const auto noise = tiling_noise(width_, height_, std::max(1.0, cell_x_m * px_per_m_),
                                  std::max(1.0, cell_y_m * px_per_m_), octaves, layer);
  for (size_t i = 0; i < pixels_.size(); ++i) pixels_[i] *= 1 + strength * noise[i];
}

void Canvas::speckle(double share, const Vec3f& color, float opacity) {
  const uint64_t layer = ++layers_ | uint64_t{1} << 32;
  for (size_t i = 0; i < pixels_.size(); ++i)
    if (stream_.uniform(i, layer) < share) pixels_[i] += opacity * (color - pixels_[i]);
}

void Canvas::blend(int x_px, int y_px, const Vec3f& color, float opacity) {
  Vec3f& p = pixels_[static_cast<size_t>(wrapped(y_px, height_)) * static_cast<size_t>(width_) +
                     static_cast<size_t>(wrapped(x_px, width_))];
  p += opacity * (color - p);
}

void Canvas::rectangle(double x0_m, double y0_m, double x1_m, double y1_m, const Vec3f& color,
                       float opacity) {
  const auto px = [&](double m) { return static_cast<int>(std::lround(m * px_per_m_)); };
  for (int y = px(y0_m); y < px(y1_m); ++y)
    for (int x = px(x0_m); x < px(x1_m); ++x) blend(x, y, color, opacity);
}

void Canvas::frame(double x0_m, double y0_m, double x1_m, double y1_m, double t_m, const Vec3f& color,
                   float opacity) {
  rectangle(x0_m, y0_m, x1_m, y0_m + t_m, color, opacity);
  rectangle(x0_m, y1_m - t_m, x1_m, y1_m, color, opacity);
  rectangle(x0_m, y0_m + t_m, x0_m + t_m, y1_m - t_m, color, opacity);
  rectangle(x1_m - t_m, y0_m + t_m, x1_m, y1_m - t_m, color, opacity);
}

void Canvas::disc(double x_m, double y_m, double radius_m, const Vec3f& color, float opacity) {
  stroke(x_m, y_m, x_m, y_m, 2 * radius_m, color, opacity);
}

void Canvas::stroke(double x0_m, double y0_m, double x1_m, double y1_m, double thickness_m,
                    const Vec3f& color, float opacity) {
  const double x0 = x0_m * px_per_m_, y0 = y0_m * px_per_m_, dx = x1_m * px_per_m_ - x0,
               dy = y1_m * px_per_m_ - y0;
  const double r = std::max(0.5, thickness_m * px_per_m_ / 2), length2 = dx * dx + dy * dy;
  const auto low = [&](double a, double d) {
    return static_cast<int>(std::floor(a + std::min(0.0, d) - r - 1));
  };
  const auto high = [&](double a, double d) {
    return static_cast<int>(std::ceil(a + std::max(0.0, d) + r + 1));
  };
  for (int y = low(y0, dy); y <= high(y0, dy); ++y)
    for (int x = low(x0, dx); x <= high(x0, dx); ++x) {
      const double px = x + 0.5 - x0, py = y + 0.5 - y0;
      const double along = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(px - along * dx, py - along * dy);
      const double cover = std::clamp(r + 0.5 - distance, 0.0, 1.0);
      if (cover > 0) blend(x, y, color, opacity * static_cast<float>(cover));
    }
}

void Canvas::text(std::string_view text, double x_m, double y_m, double height_m, const Vec3f& color) {
  const double dot_m = height_m / 7;
  for (const char letter : text) {
    for (const Glyph& glyph : kFont)
      for (int row = 0; glyph.letter == letter && row < 7; ++row)
        for (int column = 0; column < 5; ++column)
          if (glyph.rows[static_cast<size_t>(row)] >> (4 - column) & 1)
            rectangle(x_m + column * dot_m, y_m + row * dot_m, x_m + (column + 1) * dot_m,
                      y_m + (row + 1) * dot_m, color);
    x_m += 6 * dot_m;
  }
}

Texture Canvas::finish() const {
  Texture texture{name_, width_, height_, {}};
  texture.rgba.resize(4 * pixels_.size());
  for (size_t i = 0; i < pixels_.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      texture.rgba[4 * i + static_cast<size_t>(c)] =
          static_cast<uint8_t>(std::clamp(pixels_[i][c], 0.0f, 1.0f) * 255 + 0.5f);
    texture.rgba[4 * i + 3] = 255;
  }
  return texture;
}

}  // namespace vsslam

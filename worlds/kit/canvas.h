// Paints seeded textures: a float image in sRGB values 0..1 that wraps around at its edges.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/rng.h"
#include "worlds/world.h"

namespace vsslam {

/// Smooth noise that tiles: `octaves` layers, each twice as fine and 0.6 times as strong as the one before,
/// scaled to about [-1, 1]. `cell_x_px` and `cell_y_px` are the size of the coarsest layer's cells.
std::vector<float> tiling_noise(int width_px, int height_px, double cell_x_px, double cell_y_px, int octaves,
                                const RandomStream& stream);

class Canvas {
 public:
  /// `px_per_m` lets what is drawn be given in metres; y counts down from the top.
  Canvas(int width_px, int height_px, double px_per_m, uint64_t seed, std::string name);

  double width_m() const { return width_ / px_per_m_; }
  double height_m() const { return height_ / px_per_m_; }
  const RandomStream& stream() const { return stream_; }

  void fill(const Vec3f& color);
  /// Brightness times 1 + strength * noise.
  void mottle(double cell_m, int octaves, float strength) { grain(cell_m, cell_m, octaves, strength); }
  /// The same, drawn out in one direction.
  void grain(double cell_x_m, double cell_y_m, int octaves, float strength);
  /// Single pixels: a share of them blends towards `color`.
  void speckle(double share, const Vec3f& color, float opacity);
  void rectangle(double x0_m, double y0_m, double x1_m, double y1_m, const Vec3f& color, float opacity = 1);
  void frame(double x0_m, double y0_m, double x1_m, double y1_m, double thickness_m, const Vec3f& color,
             float opacity = 1);
  /// Soft-edged; wraps around.
  void disc(double x_m, double y_m, double radius_m, const Vec3f& color, float opacity = 1);
  /// A soft straight stroke.
  void stroke(double x0_m, double y0_m, double x1_m, double y1_m, double thickness_m, const Vec3f& color,
              float opacity = 1);
  /// Digits and capitals of a 5 x 7 font.
  void text(std::string_view text, double x_m, double y_m, double height_m, const Vec3f& color);

  Texture finish() const;

 private:
  void blend(int x_px, int y_px, const Vec3f& color, float opacity);

  int width_, height_;
  double px_per_m_;
  RandomStream stream_;
  std::string name_;
  uint64_t layers_ = 0;  // every noise layer draws its own numbers
  std::vector<Vec3f> pixels_;
};

}  // namespace vsslam

// The response of Shi & Tomasi's detector (CVPR 1994): the smaller eigenvalue of the mean structure tensor of the
// 5 x 5 pixels around a pixel, in (grey / px)^2.
#pragma once

#include <array>

#include "slam/vision/grey_view.h"

namespace vsslam {

/// Standard deviation of the grey values' noise (Immerkaer, CVIU 1996; with the median in place of the mean, so
/// that texture does not count as noise).
double noise_sigma_grey(const GreyView& image);

/// At one pixel, 3 pixels or more from the border of the image.
float corner_response(const GreyView& image, int x, int y);

/// The same for kSize x kSize pixels at once.
class ResponseTile {
 public:
  static constexpr int kSize = 32;
  static constexpr int kStep = 8;  ///< side of the blocks whose strongest pixel is asked for
  struct Best {
    float response;
    int x, y;  ///< in the tile
  };

  /// (x0, y0): first pixel of the tile; it needs kHalo pixels of image on each side, and kWidth bytes to be read
  /// from there on, which may run into the next row.
  void compute(const GreyView& image, int x0, int y0);
  /// Of each block from row y0 on.
  std::array<Best, kSize / kStep> best_of_blocks(int y0) const;

 private:
  static constexpr int kHalf = 2;          // of the 5 x 5 pixels
  static constexpr int kHalo = kHalf + 1;  // a response needs so many pixels on each side
  static constexpr int kGradients = kSize + 2 * kHalf;
  static constexpr int kWidth =
      48;  // kGradients and the mask rounded up, so that all loops have whole vectors
  // Fixed sizes and plain arrays: the compiler makes vector code of every loop over them.
  using Products = int[kGradients][kWidth];

  void multiply_gradients();
  static void sum_blocks(const Products& products, int y, float (&sums)[kSize]);
  void respond(int y);

  int16_t grey_[kSize + 2 * kHalo][kWidth + 2] = {};
  Products xx_, xy_, yy_;
  float response_[kSize][kSize];
};

}  // namespace vsslam

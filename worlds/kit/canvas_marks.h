// Seeded marks for painted textures.
#pragma once

#include "worlds/kit/canvas.h"

namespace vsslam {

/// The n-th draw of a picture, one after another.
class Draws {
 public:
  explicit Draws(const Canvas& canvas) : stream_(canvas.stream()) {}
  double operator()(double low, double high) { return low + (high - low) * stream_.uniform(next_++, 7); }
  Vec3f color(double low, double high) {
    const auto channel = [&] { return static_cast<float>((*this)(low, high)); };
    const float r = channel(), g = channel(), b = channel();
    return {r, g, b};
  }

 private:
  RandomStream stream_;
  uint64_t next_ = 0;
};

/// Soft dark discs: stains, grit.
void spots(Canvas& canvas, Draws& draw, int count, double smallest_m, double largest_m, float strongest);
/// Thin broken lines that wander from a random start.
void cracks(Canvas& canvas, Draws& draw, int count, int pieces, double piece_m, float opacity);

}  // namespace vsslam

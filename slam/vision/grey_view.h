// Images as functions read them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vsslam {

/// An image in somebody else's memory, 8 bits.
struct GreyView {
  const uint8_t* pixels = nullptr;
  int width_px = 0, height_px = 0;
  ptrdiff_t stride = 0;  ///< bytes from row to row

  const uint8_t* row(int y) const { return pixels + y * stride; }
};

}  // namespace vsslam

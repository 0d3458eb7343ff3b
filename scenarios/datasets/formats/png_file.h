// Grey images as PNG.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace vsslam {

/// The bytes of a PNG file, the same for the same image. `grey` is row-major, 8 bits. Lossless.
std::string encode_png_grey8(int width_px, int height_px, std::span<const uint8_t> grey);

/// The same with 16 bits: distances and the like.
std::string encode_png_grey16(int width_px, int height_px, std::span<const uint16_t> grey);

}  // namespace vsslam

// Size of an encoded image, read before anybody allocates memory for its pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace vsslam {

struct ImageSize {
  int width_px = 0, height_px = 0;
};
/// Of a PNG or a JPEG; nullopt for anything else.
std::optional<ImageSize> encoded_image_size(std::span<const uint8_t> bytes);

}  // namespace vsslam

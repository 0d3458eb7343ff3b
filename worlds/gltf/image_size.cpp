#include "worlds/gltf/image_size.h"

#include <algorithm>
#include <array>

namespace vsslam {

namespace {

int big_endian(std::span<const uint8_t> bytes, size_t at, size_t size) {
  uint32_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
  return static_cast<int>(std::min(value, uint32_t{0x7FFFFFFF}));
}

// A JPEG is a chain of segments: FF, marker, length, data. The size stands in the start-of-frame segment.
std::optional<ImageSize> jpeg_size(std::span<const uint8_t> b) {
  for (size_t at = 2; at + 9 < b.size();) {
    if (b[at] != 0xFF) return std::nullopt;
    const uint8_t marker = b[at + 1];
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) return ImageSize{big_endian(b, at + 7, 2), big_endian(b, at + 5, 2)};
    at += 2 + static_cast<size_t>(big_endian(b, at + 2, 2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageSize> encoded_image_size(std::span<const uint8_t> b) {
  constexpr std::array<uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (b.size() >= 24 && std::equal(kPng.begin(), kPng.end(), b.begin()))
    return ImageSize{big_endian(b, 16, 4), big_endian(b, 20, 4)};
  if (b.size() > 4 && b[0] == 0xFF && b[1] == 0xD8) return jpeg_size(b);
  return std::nullopt;
}

}  // namespace vsslam

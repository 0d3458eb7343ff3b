// JPEG and PNG files, by libjpeg and libpng.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// mono8 (JPEG: its Y; PNG: grey) or rgb8 (colour PNG; transparency is left out). Throws InputError that starts with
/// `place`: neither format, broken, or beyond 16384 pixels a side.
ImageMessage read_image_file(std::span<const uint8_t> bytes, std::string_view place);

}  // namespace vsslam

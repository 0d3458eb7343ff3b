// Images of other people's drivers as grey frames.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/calibration.h"
#include "core/samples.h"
#include "scenarios/datasets/messages.h"

namespace vsslam {

/// mono8 as it is; mono16: the upper byte; bgr8, rgb8, bgra8, rgba8: luma 0.299 R + 0.587 G + 0.114 B; bayer_*8: the
/// same luma of each 2 x 2 pixels, which moves the image by half a pixel; uyvy, yuyv: their Y. Throws InputError that
/// starts with `place`.
CameraFrame decode_image(const ImageMessage& image, std::string_view place);

/// A JPEG (its Y) or a PNG file (colour as above), told apart by their first bytes.
CameraFrame decode_compressed(const CompressedImageMessage& image, std::string_view place);
CameraFrame decode_image_file(std::span<const uint8_t> bytes, Time stamp, std::string_view place);

/// Throws InputError if the frame is not of the size that the sheet says.
void check_image_size(const CameraFrame& frame, const CameraCalibration& camera, std::string_view place);

}  // namespace vsslam

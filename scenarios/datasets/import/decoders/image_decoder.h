// Images of other people's drivers as grey frames.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/calibration.h"
#include "core/samples.h"
#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// How many of their 16 bits the pixels of a camera use, in the lower ones: 8, 10, 12, 14 or 16, by the largest value so
/// far. Of one camera, in order.
class PixelDepth {
 public:
  /// With this image's pixels counted in. Images of other encodings do not count.
  int after(const ImageMessage& image);
  int bits() const { return bits_; }  ///< 0: no image of 16 bits yet

 private:
  int bits_ = 0;
};

/// Empty unless fewer than 16 bits are used.
std::string note_of(const PixelDepth& depth);

/// mono8 as it is; mono16: the upper eight of the bits that are used, all 16 unless `depth` tells; bgr8, rgb8, bgra8, rgba8: luma 0.299 R + 0.587 G + 0.114 B; bayer_*8: the
/// same luma of each 2 x 2 pixels, which moves the image by half a pixel; uyvy, yuyv: their Y. Throws InputError that
/// starts with `place`.
CameraFrame decode_image(const ImageMessage& image, std::string_view place, PixelDepth* depth = nullptr);

/// A JPEG (its Y) or a PNG file (colour as above), told apart by their first bytes.
CameraFrame decode_compressed(const CompressedImageMessage& image, std::string_view place,
                              PixelDepth* depth = nullptr);
CameraFrame decode_image_file(std::span<const uint8_t> bytes, Time stamp, std::string_view place,
                              PixelDepth* depth = nullptr);

/// Throws InputError if the frame is not of the size that the sheet says.
void check_image_size(const CameraFrame& frame, const CameraCalibration& camera, std::string_view place);

}  // namespace vsslam

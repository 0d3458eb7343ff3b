#include "scenarios/datasets/import/decoders/image_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/errors.h"
#include "scenarios/datasets/formats/image_files.h"

namespace vsslam {

namespace {

// In 14 bits, as image libraries round it.
uint8_t luma(int red, int green, int blue) {
  return static_cast<uint8_t>((4899 * red + 9617 * green + 1868 * blue + 8192) >> 14);
}

struct Packing {
  std::string_view encoding;
  size_t bytes;             // of a pixel
  size_t red, green, blue;  // equal: grey, at that byte
};

constexpr Packing kPackings[] = {
    {"mono8", 1, 0, 0, 0},  {"8UC1", 1, 0, 0, 0},  {"bgr8", 3, 2, 1, 0},        {"8UC3", 3, 2, 1, 0},
    {"rgb8", 3, 0, 1, 2},   {"bgra8", 4, 2, 1, 0}, {"rgba8", 4, 0, 1, 2},       {"8UC4", 4, 2, 1, 0},
    {"yuv422", 2, 1, 1, 1}, {"uyvy", 2, 1, 1, 1},  {"yuv422_yuy2", 2, 0, 0, 0}, {"yuyv", 2, 0, 0, 0},
};

// Which of a 2 x 2 block's pixels, row by row, is red, and which is blue; the other two are green.
struct Mosaic {
  std::string_view encoding;
  size_t red, blue;
};
constexpr Mosaic kMosaics[] = {
    {"bayer_rggb8", 0, 3}, {"bayer_bggr8", 3, 0}, {"bayer_gbrg8", 2, 1}, {"bayer_grbg8", 1, 2}};

void check_size(const ImageMessage& image, size_t pixel_bytes, std::string_view place) {
  const uint64_t row = uint64_t{image.width} * pixel_bytes;
  if (image.width == 0 || image.height == 0 || row > image.step ||
      uint64_t{image.step} * image.height > image.data.size())
    throw InputError(fmt::format("{}: expected {} x {} pixels ({}) in rows of {} bytes, got {} bytes of data",
                                 place, image.width, image.height, image.encoding, image.step,
                                 image.data.size()));
}

CameraFrame frame_for(const ImageMessage& image) {
  CameraFrame frame{image.header.stamp, static_cast<int>(image.width), static_cast<int>(image.height), {}};
  frame.grey.resize(size_t{image.width} * image.height);
  return frame;
}

bool has_16_bits(const ImageMessage& image) {
  return image.encoding == "mono16" || image.encoding == "16UC1";
}

template <class EachValue>
void each_of_16_bits(const ImageMessage& image, EachValue&& each) {
  const size_t upper = image.is_bigendian ? 0 : 1;
  for (uint32_t row = 0; row < image.height; ++row) {
    const uint8_t* pixel = image.data.data() + size_t{row} * image.step;
    for (uint32_t column = 0; column < image.width; ++column, pixel += 2)
      each(static_cast<uint32_t>(pixel[upper] << 8 | pixel[1 - upper]));
  }
}

CameraFrame unpack_16_bits(const ImageMessage& image, int bits, std::string_view place) {
  check_size(image, 2, place);
  CameraFrame frame = frame_for(image);
  uint8_t* out = frame.grey.data();
  each_of_16_bits(image, [&](uint32_t value) { *out++ = static_cast<uint8_t>(value >> (bits - 8)); });
  return frame;
}

CameraFrame unpack(const ImageMessage& image, const Packing& packing, std::string_view place) {
  check_size(image, packing.bytes, place);
  CameraFrame frame = frame_for(image);
  uint8_t* out = frame.grey.data();
  for (uint32_t row = 0; row < image.height; ++row) {
    const uint8_t* pixel = image.data.data() + size_t{row} * image.step;
    for (uint32_t column = 0; column < image.width; ++column, pixel += packing.bytes)
      *out++ = packing.red == packing.blue
                   ? pixel[packing.green]
                   : luma(pixel[packing.red], pixel[packing.green], pixel[packing.blue]);
  }
  return frame;
}

// Each pixel from the 2 x 2 block that it begins; the block's colours come in another order where it begins on an odd
// row or column.
CameraFrame demosaic(const ImageMessage& image, const Mosaic& mosaic, std::string_view place) {
  check_size(image, 1, place);
  if (image.width < 2 || image.height < 2)
    throw InputError(fmt::format("{}: an image of {} needs 2 x 2 pixels", place, image.encoding));
  CameraFrame frame = frame_for(image);
  for (uint32_t row = 0; row < image.height; ++row)
    for (uint32_t column = 0; column < image.width; ++column) {
      const uint32_t top = std::min(row, image.height - 2), left = std::min(column, image.width - 2);
      int red = 0, green = 0, blue = 0;
      for (uint32_t y = top; y < top + 2; ++y)
        for (uint32_t x = left; x < left + 2; ++x) {
          const size_t colour = (y % 2) * 2 + x % 2;
          const int value = image.data[size_t{y} * image.step + x];
          (colour == mosaic.red ? red : colour == mosaic.blue ? blue : green) += value;
        }
      frame.grey[size_t{row} * image.width + column] = luma(red, green / 2, blue);
    }
  return frame;
}

}  // namespace

int PixelDepth::after(const ImageMessage& image) {
  if (!has_16_bits(image)) return bits_;
  check_size(image, 2, "image");
  uint32_t used = 0;
  each_of_16_bits(image, [&](uint32_t value) { used |= value; });
  int bits = 8;
  while (used >> bits != 0) bits += 2;
  return bits_ = std::max(bits_, bits);
}

std::string note_of(const PixelDepth& depth) {
  if (depth.bits() == 0 || depth.bits() == 16) return {};
  return fmt::format("camera: of its pixels' 16 bits the lower {} are used: the upper 8 of these are taken",
                     depth.bits());
}

CameraFrame decode_image(const ImageMessage& image, std::string_view place, PixelDepth* depth) {
  if (has_16_bits(image)) {
    check_size(image, 2, place);
    return unpack_16_bits(image, depth == nullptr ? 16 : depth->after(image), place);
  }
  for (const Packing& packing : kPackings)
    if (packing.encoding == image.encoding) return unpack(image, packing, place);
  for (const Mosaic& mosaic : kMosaics)
    if (mosaic.encoding == image.encoding) return demosaic(image, mosaic, place);
  throw InputError(
      fmt::format("{}: images of encoding \"{}\" are not read (mono8, mono16, bgr8, rgb8, bgra8, rgba8, "
                  "bayer_*8, yuv422, "
                  "yuv422_yuy2 are)",
                  place, image.encoding));
}

CameraFrame decode_compressed(const CompressedImageMessage& image, std::string_view place,
                              PixelDepth* depth) {
  return decode_image_file(image.data, image.header.stamp, place, depth);
}

CameraFrame decode_image_file(std::span<const uint8_t> bytes, Time stamp, std::string_view place,
                              PixelDepth* depth) {
  ImageMessage image = read_image_file(bytes, place);
  image.header.stamp = stamp;
  return decode_image(image, place, depth);
}

void check_image_size(const CameraFrame& frame, const CameraCalibration& camera, std::string_view place) {
  if (frame.width_px != camera.width_px || frame.height_px != camera.height_px)
    throw InputError(fmt::format("{}: an image of {} x {} pixels, but the rig's sheet is for {} x {}", place,
                                 frame.width_px, frame.height_px, camera.width_px, camera.height_px));
}

}  // namespace vsslam

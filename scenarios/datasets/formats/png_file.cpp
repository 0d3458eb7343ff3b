#include "scenarios/datasets/formats/png_file.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <utility>
#include <vector>

#include "core/errors.h"

namespace vsslam {

namespace {

/// How pixels are predicted, and how what is left is searched for repetitions.
struct Compression {
  int level, strategy, filters;
};
// The noise of a camera does not repeat: looking for runs only takes half the time and a better prediction more than
// makes up for it. Depth is smooth and does.
constexpr Compression kCameraImage{1, Z_RLE, PNG_FILTER_AVG}, kSmoothImage{2, Z_FILTERED, PNG_FILTER_SUB};

/// libpng's writer; what it allocated goes with it.
struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string bytes;

  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
    if (png) info = png_create_info_struct(png);
    if (!info) throw ResourceError("out of memory for a PNG image");
    png_set_write_fn(png, &bytes, append, nullptr);
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  static void append(png_structp png, png_bytep data, png_size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
  }
  [[noreturn]] static void fail(png_structp, png_const_charp message) {
    throw ResourceError(fmt::format("cannot encode a PNG image: {}", message));
  }
};

/// `rows`: bytes as PNG has them.
std::string encode(int width_px, int height_px, int bits, std::span<const uint8_t> rows) {
  const auto row_bytes = static_cast<size_t>(width_px) * static_cast<size_t>(bits / 8);
  Writer writer;
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(width_px),
               static_cast<png_uint_32>(height_px), bits, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const Compression& compression = bits == 8 ? kCameraImage : kSmoothImage;
  png_set_compression_level(writer.png, compression.level);
  png_set_compression_strategy(writer.png, compression.strategy);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, compression.filters);
  png_write_info(writer.png, writer.info);
  for (size_t y = 0; y < static_cast<size_t>(height_px); ++y)
    png_write_row(writer.png, rows.data() + y * row_bytes);
  png_write_end(writer.png, writer.info);
  return std::move(writer.bytes);
}

void check_size(int width_px, int height_px, size_t values) {
  if (width_px <= 0 || height_px <= 0 ||
      values != static_cast<size_t>(width_px) * static_cast<size_t>(height_px))
    throw InputError(
        fmt::format("an image of {} x {} pixels cannot have {} values", width_px, height_px, values));
}

}  // namespace

std::string encode_png_grey8(int width_px, int height_px, std::span<const uint8_t> grey) {
  check_size(width_px, height_px, grey.size());
  return encode(width_px, height_px, 8, grey);
}

std::string encode_png_grey16(int width_px, int height_px, std::span<const uint16_t> grey) {
  check_size(width_px, height_px, grey.size());
  std::vector<uint8_t> rows;  // most significant byte first
  rows.reserve(2 * grey.size());
  for (const uint16_t value : grey) {
    rows.push_back(static_cast<uint8_t>(value >> 8));
    rows.push_back(static_cast<uint8_t>(value));
  }
  return encode(width_px, height_px, 16, rows);
}

}  // namespace vsslam

#include "scenarios/png_file.h"

#include <fmt/format.h>
#include <png.h>

#include <utility>

#include "core/errors.h"

namespace vsslam {

namespace {

// The fastest of the levels that predict at all: noisy images gain next to nothing from the slower ones.
constexpr int kCompressionLevel = 2;

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

}  // namespace

std::string encode_png_grey8(int width_px, int height_px, std::span<const uint8_t> grey) {
  const auto width = static_cast<size_t>(width_px), height = static_cast<size_t>(height_px);
  if (width_px <= 0 || height_px <= 0 || grey.size() != width * height)
    throw InputError(
        fmt::format("an image of {} x {} pixels cannot have {} values", width_px, height_px, grey.size()));
  Writer writer;
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(width_px),
               static_cast<png_uint_32>(height_px), 8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(writer.png, kCompressionLevel);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_write_info(writer.png, writer.info);
  for (size_t y = 0; y < height; ++y) png_write_row(writer.png, grey.data() + y * width);
  png_write_end(writer.png, writer.info);
  return std::move(writer.bytes);
}

}  // namespace vsslam

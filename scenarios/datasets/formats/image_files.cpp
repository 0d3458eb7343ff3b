#include "scenarios/datasets/formats/image_files.h"

#include <fmt/format.h>
#include <jpeglib.h>
#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it before
#include <cstring>
#include <string>

#include "core/errors.h"

namespace vsslam {

namespace {

constexpr uint32_t kMostPixels = 16384;

void check_size(uint32_t width, uint32_t height, std::string_view place) {
  if (width == 0 || height == 0 || width > kMostPixels || height > kMostPixels)
    throw InputError(fmt::format("{}: an image of {} x {} pixels", place, width, height));
}

ImageMessage image_of(uint32_t width, uint32_t height, const char* encoding, uint32_t pixel_bytes) {
  ImageMessage image;
  image.width = width;
  image.height = height;
  image.encoding = encoding;
  image.step = width * pixel_bytes;
  image.data.resize(size_t{image.step} * height);
  return image;
}

struct JpegError {
  jpeg_error_mgr manager;
  std::jmp_buf back;
  std::array<char, JMSG_LENGTH_MAX> text;
};

void leave(j_common_ptr jpeg) {
  auto* error = reinterpret_cast<JpegError*>(jpeg->err);
  (*jpeg->err->format_message)(jpeg, error->text.data());
  std::longjmp(error->back, 1);
}

// Warnings are errors too: a truncated file would come out half grey.
void warn(j_common_ptr jpeg, int level) {
  if (level < 0) leave(jpeg);
}

// libjpeg leaves by longjmp: nothing here may need a destructor.
bool jpeg_header(jpeg_decompress_struct& jpeg, JpegError& error, std::span<const uint8_t> bytes) {
  if (setjmp(error.back)) return false;
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  jpeg.out_color_space = JCS_GRAYSCALE;
  jpeg.dct_method = JDCT_ISLOW;
  return true;
}

bool jpeg_rows(jpeg_decompress_struct& jpeg, JpegError& error, uint8_t* grey, size_t step) {
  if (setjmp(error.back)) return false;
  jpeg_start_decompress(&jpeg);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = grey + step * jpeg.output_scanline;
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

ImageMessage read_jpeg(std::span<const uint8_t> bytes, std::string_view place) {
  jpeg_decompress_struct jpeg{};
  JpegError error{};
  jpeg.err = jpeg_std_error(&error.manager);
  error.manager.error_exit = leave;
  error.manager.emit_message = warn;
  const struct Release {
    jpeg_decompress_struct& jpeg;
    ~Release() { jpeg_destroy_decompress(&jpeg); }
  } release{jpeg};
  const auto fail = [&] { throw InputError(fmt::format("{}: JPEG: {}", place, error.text.data())); };
  if (!jpeg_header(jpeg, error, bytes)) fail();
  check_size(jpeg.image_width, jpeg.image_height, place);
  ImageMessage image = image_of(jpeg.image_width, jpeg.image_height, "mono8", 1);
  if (!jpeg_rows(jpeg, error, image.data.data(), image.step)) fail();
  return image;
}

ImageMessage read_png(std::span<const uint8_t> bytes, std::string_view place) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const struct Release {
    png_image& png;
    ~Release() { png_image_free(&png); }
  } release{png};
  const auto fail = [&] { throw InputError(fmt::format("{}: PNG: {}", place, png.message)); };
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) fail();
  check_size(png.width, png.height, place);
  const bool color = (png.format & PNG_FORMAT_FLAG_COLOR) != 0;
  const bool deep = !color && (png.format & PNG_FORMAT_FLAG_LINEAR) != 0;  // 16 bits
  png.format = color ? PNG_FORMAT_RGB : deep ? PNG_FORMAT_LINEAR_Y : PNG_FORMAT_GRAY;
  ImageMessage image = image_of(png.width, png.height,
                                color  ? "rgb8"
                                : deep ? "mono16"
                                       : "mono8",
                                color  ? 3
                                : deep ? 2
                                       : 1);
  const png_color black{};
  if (!png_image_finish_read(&png, &black, image.data.data(),
                             static_cast<png_int_32>(deep ? image.width : image.step), nullptr))
    fail();
  return image;
}

}  // namespace

ImageMessage read_image_file(std::span<const uint8_t> bytes, std::string_view place) {
  if (bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF)
    return read_jpeg(bytes, place);
  if (bytes.size() >= 8 && std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8) == 0)
    return read_png(bytes, place);
  throw InputError(fmt::format("{}: neither a JPEG nor a PNG file", place));
}

}  // namespace vsslam

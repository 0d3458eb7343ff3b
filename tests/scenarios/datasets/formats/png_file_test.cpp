#include "scenarios/datasets/formats/png_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include <vector>

#include "core/errors.h"
#include "core/rng.h"

namespace vsslam {
namespace {

struct Decoded {
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> grey;
};

// By libpng's simplified reader, which shares nothing with the writer but the library.
Decoded decode(const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_GRAY));
  Decoded decoded{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  decoded.grey.resize(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, decoded.grey.data(), 0, nullptr));
  return decoded;
}

TEST(PngFile, DecodesToTheSameImage) {
  const RandomStream noise(1, "image");
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{1, 1}, std::pair{7, 3}}) {
    std::vector<uint8_t> grey(static_cast<size_t>(width * height));
    for (size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<uint8_t>(i / 7 + noise.bits(i) % 9);
    const std::string bytes = encode_png_grey8(width, height, grey);
    const Decoded decoded = decode(bytes);
    EXPECT_EQ(decoded.width_px, width);
    EXPECT_EQ(decoded.height_px, height);
    EXPECT_EQ(decoded.grey, grey);
    EXPECT_EQ(bytes, encode_png_grey8(width, height, grey));
  }
}

TEST(PngFile, SixteenBitsKeepTheirOrder) {
  const std::vector<uint16_t> depth_mm = {0, 1, 256, 65535};
  const std::string bytes = encode_png_grey16(2, 2, depth_mm);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  image.format = PNG_FORMAT_LINEAR_Y;
  std::vector<uint16_t> decoded(4);
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, decoded.data(), 0, nullptr));
  // The simplified reader takes 16 bits as they are but for the file's gamma, which is not there.
  EXPECT_EQ(decoded.front(), 0);
  EXPECT_EQ(decoded.back(), 65535);
  EXPECT_EQ(bytes[24], 16);  // IHDR: bit depth
  EXPECT_EQ(bytes[25], 0);   // grey
}

TEST(PngFile, RefusesImagesOfTheWrongSize) {
  const std::vector<uint8_t> grey(12);
  EXPECT_THROW(encode_png_grey8(5, 3, grey), InputError);
  EXPECT_THROW(encode_png_grey8(0, 0, {}), InputError);
}

}  // namespace
}  // namespace vsslam

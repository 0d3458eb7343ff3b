#include "scenarios/datasets/import/decoders/image_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jpeglib.h>

#include <cstdio>
#include <cstdlib>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/datasets/formats/png_file.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ImageMessage image(const char* encoding, uint32_t width, uint32_t height, std::vector<uint8_t> data) {
  ImageMessage message;
  message.encoding = encoding;
  message.width = width;
  message.height = height;
  message.step = static_cast<uint32_t>(data.size()) / height;
  message.data = std::move(data);
  return message;
}

std::vector<uint8_t> grey_of(const ImageMessage& message) {
  return decode_image(message, "here").grey;
}

TEST(ImageDecoder, MakesGreyOfEveryEncoding) {
  EXPECT_THAT(grey_of(image("mono8", 2, 1, {7, 250})), ElementsAre(7, 250));
  EXPECT_THAT(grey_of(image("mono16", 2, 1, {255, 7, 0, 250})), ElementsAre(7, 250));
  // 0.299 R + 0.587 G + 0.114 B of pure colours.
  EXPECT_THAT(grey_of(image("rgb8", 3, 1, {255, 0, 0, 0, 255, 0, 0, 0, 255})), ElementsAre(76, 150, 29));
  EXPECT_THAT(grey_of(image("bgr8", 3, 1, {255, 0, 0, 0, 255, 0, 0, 0, 255})), ElementsAre(29, 150, 76));
  EXPECT_THAT(grey_of(image("bgra8", 1, 1, {255, 0, 0, 9})), ElementsAre(29));
  EXPECT_THAT(grey_of(image("yuv422", 2, 1, {1, 100, 2, 200})), ElementsAre(100, 200));
  EXPECT_THAT(grey_of(image("rgb8", 1, 1, {93, 93, 93})), ElementsAre(93));
}

TEST(ImageDecoder, TakesTheUpperEightOfTheBitsThatAreUsed) {
  const auto of_bits = [](int bits) {
    const int largest = (1 << bits) - 1, less = largest / 4;
    ImageMessage message = image("mono16", 2, 1, {0, 0, 0, 0});
    message.data = {static_cast<uint8_t>(largest), static_cast<uint8_t>(largest >> 8),
                    static_cast<uint8_t>(less), static_cast<uint8_t>(less >> 8)};
    return message;
  };
  for (const int bits : {8, 10, 12, 14, 16}) {
    PixelDepth depth;
    EXPECT_THAT(decode_image(of_bits(bits), "here", &depth).grey, ElementsAre(255, 63)) << bits;
    EXPECT_EQ(depth.bits(), bits);
    EXPECT_EQ(note_of(depth).empty(), bits == 16);
  }
  PixelDepth depth;
  decode_image(of_bits(10), "here", &depth);
  EXPECT_THAT(decode_image(of_bits(12), "here", &depth).grey, ElementsAre(255, 63));
  EXPECT_THAT(decode_image(of_bits(10), "here", &depth).grey, ElementsAre(63, 15));
}

TEST(ImageDecoder, DemosaicsToTheLumaOfEachBlock) {
  // Red 255 and nothing else, on 4 x 2 pixels.
  const std::vector<uint8_t> red_first = {255, 0, 255, 0, 0, 0, 0, 0};
  EXPECT_THAT(grey_of(image("bayer_rggb8", 4, 2, red_first)), Each(76));
  EXPECT_THAT(grey_of(image("bayer_bggr8", 4, 2, red_first)), Each(29));
}

TEST(ImageDecoder, RowsMayBeLongerThanTheirPixels) {
  EXPECT_THAT(grey_of(image("mono8", 2, 2, {1, 2, 99, 3, 4, 99})), ElementsAre(1, 2, 3, 4));
}

TEST(ImageDecoder, PngKeepsEveryPixel) {
  std::vector<uint8_t> grey(64 * 48);
  for (size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<uint8_t>(i * 7 % 256);
  const std::string bytes = encode_png_grey8(64, 48, grey);
  const CompressedImageMessage message{{0, Time{5}, ""}, "png", {bytes.begin(), bytes.end()}};
  const CameraFrame frame = decode_compressed(message, "here");
  EXPECT_EQ(frame.stamp, Time{5});
  EXPECT_EQ(frame.width_px, 64);
  EXPECT_EQ(frame.grey, grey);
}

std::vector<uint8_t> jpeg_of(int width, int height, const std::vector<uint8_t>& rgb) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  for (int row = 0; row < height; ++row) {
    auto* start = const_cast<uint8_t*>(rgb.data() + static_cast<size_t>(3 * width * row));
    jpeg_write_scanlines(&jpeg, &start, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::vector<uint8_t> result(bytes, bytes + size);
  jpeg_destroy_compress(&jpeg);
  std::free(bytes);
  return result;
}

TEST(ImageDecoder, JpegGivesItsLuma) {
  std::vector<uint8_t> rgb;
  for (int i = 0; i < 32 * 16; ++i) rgb.insert(rgb.end(), {200, 40, 90});
  const std::vector<uint8_t> bytes = jpeg_of(32, 16, rgb);
  const CameraFrame frame = decode_image_file(bytes, Time{0}, "here");
  EXPECT_EQ(frame.height_px, 16);
  for (const uint8_t grey : frame.grey) EXPECT_NEAR(grey, 0.299 * 200 + 0.587 * 40 + 0.114 * 90, 2);
}

TEST(ImageDecoder, BrokenImagesAreErrorsWithAPlace) {
  const auto fails = [](const std::function<void()>& read, const char* what) {
    EXPECT_THAT(read, ThrowsMessage<InputError>(::testing::AllOf(HasSubstr("here"), HasSubstr(what))));
  };
  fails([] { grey_of(image("32FC1", 1, 1, {0, 0, 0, 0})); }, "32FC1");
  fails([] { grey_of(image("rgb8", 2, 1, {0, 0, 0})); }, "2 x 1");
  std::vector<uint8_t> rgb(3 * 64 * 64);
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<uint8_t>(i * i);
  std::vector<uint8_t> bytes = jpeg_of(64, 64, rgb);
  bytes.resize(bytes.size() / 2);
  fails([&] { decode_image_file(bytes, Time{0}, "here"); }, "JPEG");
  bytes.resize(2);
  fails([&] { decode_image_file(bytes, Time{0}, "here"); }, "neither");
  const std::vector<uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0};
  fails([&] { decode_image_file(png, Time{0}, "here"); }, "PNG");
}

}  // namespace
}  // namespace vsslam

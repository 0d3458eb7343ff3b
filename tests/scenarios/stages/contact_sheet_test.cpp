#include "scenarios/stages/contact_sheet.h"

#include <gtest/gtest.h>

namespace vsslam {
namespace {

// Width and height stand in the 17th to 24th byte of a PNG.
int big_endian(const std::string& bytes, size_t at) {
  int value = 0;
  for (size_t i = at; i < at + 4; ++i) value = 256 * value + static_cast<uint8_t>(bytes[i]);
  return value;
}

CameraFrame plain(int grey) {
  return {.stamp = Time{0},
          .width_px = 8,
          .height_px = 4,
          .grey = std::vector<uint8_t>(32, static_cast<uint8_t>(grey))};
}

TEST(ContactSheet, NothingSeenIsNothing) {
  EXPECT_EQ(ContactSheet().png(), "");
}

TEST(ContactSheet, HoldsEightPicturesOfHalfTheSize) {
  ContactSheet sheet;
  for (int i = 0; i < 3; ++i) sheet.add(plain(100));
  const std::string png = sheet.png();
  EXPECT_EQ(big_endian(png, 16), 4 * 4);
  EXPECT_EQ(big_endian(png, 20), 2 * 2);
}

// The first and the newest kept one are shown, whatever the number of images; its bytes depend on them only.
TEST(ContactSheet, SpreadsOverTheWholeRun) {
  ContactSheet few, many, other;
  for (int i = 0; i < 8; ++i) few.add(plain(10 * i));
  for (int i = 0; i < 1024; ++i) {
    many.add(plain(i / 4));
    other.add(plain(i < 512 ? i / 4 : 0));
  }
  EXPECT_NE(few.png(), many.png());
  EXPECT_NE(many.png(), other.png());
  EXPECT_LT(many.png().size(), 1000u);
}

}  // namespace
}  // namespace vsslam

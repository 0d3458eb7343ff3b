#include "scenarios/datasets/formats/chunk_compression.h"

#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include "core/rng.h"

namespace vsslam {
namespace {

/// Of several of the compressors' blocks; half of it compresses.
std::string content() {
  std::string bytes(3'000'000, '\0');
  const RandomStream noise(1, "content");
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(noise.bits(i) & 0x0f);
  return bytes;
}

std::string lz4(const std::string& bytes) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockSizeID = LZ4F_max256KB;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string out(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), &preferences));
  return out;
}

std::string bz2(std::string bytes) {
  std::string out(bytes.size() + bytes.size() / 50 + 1000, '\0');
  auto size = static_cast<unsigned>(out.size());
  EXPECT_EQ(
      BZ2_bzBuffToBuffCompress(out.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), 1, 0, 0),
      BZ_OK);
  out.resize(size);
  return out;
}

class Compressions : public testing::TestWithParam<const char*> {
 protected:
  std::string compressed(const std::string& bytes) const {
    const std::string_view name = GetParam();
    return name == "lz4"    ? lz4(bytes)
           : name == "bz2"  ? bz2(bytes)
           : name == "zstd" ? compress_zstd(bytes)
                            : bytes;
  }
};
INSTANTIATE_TEST_SUITE_P(Datasets, Compressions, testing::Values("none", "lz4", "bz2", "zstd"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(Compressions, GiveBackTheContent) {
  for (const std::string& bytes : {content(), std::string("short"), std::string()}) {
    const Decompressed back = decompress(GetParam(), compressed(bytes), bytes.size());
    EXPECT_EQ(back.damage, "");
    EXPECT_EQ(back.bytes, bytes);
  }
}

TEST_P(Compressions, KeepWhatComesBeforeATruncation) {
  const std::string bytes = content();
  const std::string whole = compressed(bytes);
  const Decompressed part = decompress(GetParam(), whole.substr(0, whole.size() / 2), bytes.size());
  EXPECT_NE(part.damage, "");
  EXPECT_GT(part.bytes.size(), bytes.size() / 4);
  EXPECT_LT(part.bytes.size(), bytes.size() * 3 / 4);
  EXPECT_TRUE(bytes.starts_with(part.bytes));
}

TEST_P(Compressions, NoticeAnotherSizeThanAnnounced) {
  const std::string bytes = content();
  const std::string whole = compressed(bytes);
  for (const size_t announced : {bytes.size() - 1, bytes.size() + 1, size_t{0}, size_t{1} << 40}) {
    const Decompressed other = decompress(GetParam(), whole, announced);
    EXPECT_NE(other.damage, "") << announced;
    EXPECT_LE(other.bytes.size(), announced);
    EXPECT_LE(other.bytes.size(), bytes.size());
  }
}

TEST(Compression, OfAnotherNameIsDamage) {
  EXPECT_EQ(decompress("snappy", "abc", 3).damage, "compression \"snappy\" is not known here");
  EXPECT_EQ(decompress("", "abc", 3).bytes, "abc");
}

}  // namespace
}  // namespace vsslam

#include "worlds/gltf/container.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>

#include "core/errors.h"

namespace vsslam {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

namespace {

uint32_t word_at(std::string_view bytes, size_t at) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

}  // namespace

std::string_view gltf_json_text(std::string_view bytes, const std::string& file) {
  constexpr uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A;
  if (bytes.size() < 4 || word_at(bytes, 0) != kMagic) return bytes;
  const auto fail = [&](const std::string& message) { throw InputError(file + ": " + message); };
  if (bytes.size() < 20) fail("truncated: a .glb has a header of 20 bytes");
  if (word_at(bytes, 4) != 2) fail(fmt::format("container version {}, expected 2", word_at(bytes, 4)));
  const size_t length = word_at(bytes, 8), json_bytes = word_at(bytes, 12);
  if (length > bytes.size()) fail(fmt::format("truncated: {} of {} bytes", bytes.size(), length));
  if (word_at(bytes, 16) != kJson) fail("its first chunk is not JSON");
  if (20 + json_bytes > length) fail("the JSON chunk is longer than the file");
  if (20 + json_bytes + 8 <= length && 20 + json_bytes + 8 + size_t{word_at(bytes, 20 + json_bytes)} > length)
    fail("the binary chunk is longer than the file");
  return bytes.substr(20, json_bytes);
}

}  // namespace vsslam

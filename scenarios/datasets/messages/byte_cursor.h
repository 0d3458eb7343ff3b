// Reads little-endian numbers and runs of bytes in order, and never beyond the end.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace vsslam {

static_assert(std::endian::native == std::endian::little, "bytes are copied as they are");

template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  /// Byte that comes next, from 0.
  size_t at() const { return at_; }
  size_t left() const { return bytes_.size() - at_; }
  /// The next `size` bytes. Throws InputError if so many are not left.
  std::string_view take(uint64_t size) {
    if (size > left()) fail(size);
    const std::string_view taken = bytes_.substr(at_, static_cast<size_t>(size));
    at_ += static_cast<size_t>(size);
    return taken;
  }
  template <Number T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  /// Bytes after their number as `Size`.
  template <Number Size>
  std::string_view counted() {
    return take(number<Size>());
  }

 private:
  [[noreturn]] void fail(uint64_t size) const;

  std::string_view bytes_;
  size_t at_ = 0;
};

/// Appends a number's bytes.
template <Number T>
void put_number(auto& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

}  // namespace vsslam

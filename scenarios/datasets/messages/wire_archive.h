// The archives that members() fills: they know how numbers, strings, lists, times and rotations become bytes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenarios/datasets/messages/byte_cursor.h"
#include "scenarios/datasets/messages/message_members.h"
#include "scenarios/datasets/messages/wire_format.h"

namespace vsslam {

/// Alignment counts from behind it.
inline constexpr size_t kCdrHeaderBytes = 4;

class WireWriter {
 public:
  template <class T>
  using Of = const T;

  WireWriter(WireFormat format, std::string& bytes);

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  void sequence(uint32_t seq) {
    if (format_ == WireFormat::ros1) put(seq);
  }

 private:
  template <Number T>
  void put(const T& value) {
    put_run(&value, 1);
  }
  void put(const bool& value) { put(static_cast<uint8_t>(value)); }
  void put(const std::string& text);
  void put(const Time& stamp);
  void put(const Vec3& v) { put_run(v.data(), 3); }
  void put(const Quat& q) { put_run(q.coeffs().data(), 4); }  // x y z w, as ROS has it
  void put(const SE3& T) { (*this)(T.translation, T.rotation); }
  template <Number T, size_t N>
  void put(const std::array<T, N>& values) {
    put_run(values.data(), N);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<uint32_t>(values.size()));
    if constexpr (Number<T>)
      put_run(values.data(), values.size());
    else
      for (const T& value : values) put(value);
  }
  template <class Struct>
  void put(const Struct& value) {
    members(*this, value);
  }
  template <Number T>
  void put_run(const T* values, size_t count) {
    if (count == 0) return;  // nothing is aligned for nothing
    align(sizeof(T));
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }
  void align(size_t size) {
    if (format_ == WireFormat::cdr) bytes_.append(-(bytes_.size() - kCdrHeaderBytes) % size, '\0');
  }

  WireFormat format_;
  std::string& bytes_;
};

class WireReader {
 public:
  template <class T>
  using Of = T;

  WireReader(WireFormat format, std::string_view bytes);
  /// Throws InputError if bytes are left over, but for the padding that CDR allows at the end.
  void finish() const;

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  void sequence(uint32_t& seq) {
    if (format_ == WireFormat::ros1) get(seq);
  }

 private:
  template <Number T>
  void get(T& value) {
    get_run(&value, 1);
  }
  void get(bool& value);
  void get(std::string& text);
  void get(Time& stamp);
  void get(Vec3& v) { get_run(v.data(), 3); }
  void get(Quat& q) { get_run(q.coeffs().data(), 4); }
  void get(SE3& T);
  template <Number T, size_t N>
  void get(std::array<T, N>& values) {
    get_run(values.data(), N);
  }
  template <class T>
  void get(std::vector<T>& values) {
    uint32_t count = 0;
    get(count);
    values.clear();
    if constexpr (Number<T>) {
      if (count > cursor_.left() / sizeof(T)) fail_count(count);
      values.resize(count);
      get_run(values.data(), count);
    } else {
      // Grown as it is read: a broken count ends with the bytes, not with the memory.
      for (uint32_t i = 0; i < count; ++i) get(values.emplace_back());
    }
  }
  template <class Struct>
  void get(Struct& value) {
    members(*this, value);
  }
  template <Number T>
  void get_run(T* values, size_t count) {
    if (count == 0) return;
    align(sizeof(T));
    std::memcpy(values, cursor_.take(count * sizeof(T)).data(), count * sizeof(T));
  }
  void align(size_t size) {
    if (format_ == WireFormat::cdr) cursor_.take(-(cursor_.at() - kCdrHeaderBytes) % size);
  }
  [[noreturn]] void fail_count(uint32_t count) const;

  WireFormat format_;
  ByteCursor cursor_;
};

}  // namespace vsslam

// Strict configuration: one struct with defaults = one YAML mapping. Unknown keys, wrong types, impossible
// values and duplicate keys are errors with file:line:column and the nearest valid key.
//
// A struct takes part by listing its members once; the same list loads, saves and documents it:
//
//   struct LidarConfig {
//     double max_range_m = 100.0;
//     Mode mode = Mode::strongest;
//     void fields(Fields& f) {
//       f("max_range_m", max_range_m, positive());
//       f.choice("mode", mode, {{"strongest", Mode::strongest}, {"last", Mode::last}});
//       f.check(max_range_m > 1, "max_range_m", "more than 1 m");
//     }
//   };
//
// Keys carry their unit as the last word (_m, _s, _rad, _deg, _hz, _mps).
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/se3.h"

namespace vsslam {

/// Allowed values of a number. Values are always finite.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;  ///< the value `low` itself is not allowed
};
inline Range any_value() { return {}; }
inline Range positive() { return {.low = 0, .low_open = true}; }
inline Range non_negative() { return {.low = 0}; }
inline Range at_least(double low) { return {.low = low}; }
inline Range between(double low, double high) { return {.low = low, .high = high}; }

/// Finds library files: kind is a folder name ("worlds", "rigs", "scenarios", ...), name a bare name.
/// Returns an empty path if there is none.
using Library = std::function<std::filesystem::path(std::string_view kind, std::string_view name)>;

/// Visitor over the members of a config struct. Loading overwrites the members whose keys are present.
class Fields {
 public:
  virtual ~Fields() = default;

  void operator()(const char* key, double& value, Range range = any_value()) { number(key, value, range); }
  void operator()(const char* key, float& value, Range range = any_value());
  void operator()(const char* key, int& value, Range range = any_value());
  void operator()(const char* key, int64_t& value, Range range = any_value()) { integer(key, value, range); }
  void operator()(const char* key, uint64_t& value) { unsigned_integer(key, value); }
  void operator()(const char* key, bool& value) { boolean(key, value); }
  void operator()(const char* key, std::string& value) { text(key, value); }
  /// A sequence of exactly N numbers.
  void operator()(const char* key, Vec3& value, Range range = any_value()) { numbers(key, value.data(), 3, range); }
  void operator()(const char* key, Eigen::Vector2d& value, Range range = any_value()) {
    numbers(key, value.data(), 2, range);
  }

  /// A number, or the word `automatic` for nullopt: the program derives it.
  void automatic(const char* key, std::optional<double>& value, Range range = any_value()) {
    number_or_automatic(key, value, range);
  }

  /// A nested mapping.
  template <class T>
    requires requires(T& t, Fields& f) { t.fields(f); }
  void operator()(const char* key, T& value) {
    if (!enter(key, true)) return;
    value.fields(*this);
    leave();
  }
  /// Present if and only if the key is.
  template <class T>
  void operator()(const char* key, std::optional<T>& value) {
    if (!enter_optional(key, value.has_value())) return;
    if (!value) value.emplace();
    (*this)(key, *value);
  }
  /// A sequence of numbers, strings or mappings; replaces the default as a whole.
  template <class T>
  void operator()(const char* key, std::vector<T>& value) {
    size_t size = value.size();
    if (!enter_list(key, size)) return;
    if (loading()) value.assign(size, T{});
    for (size_t i = 0; i < size; ++i) {
      if constexpr (requires(T& t, Fields& f) { t.fields(f); }) {
        enter_item(i);
        value[i].fields(*this);
        leave();
      } else {
        item(i, value[i]);
      }
    }
    leave();
  }
  /// A mapping with free keys.
  template <class T>
  void operator()(const char* key, std::map<std::string, T>& value) {
    if (!enter(key, !value.empty())) return;
    for (const std::string& name : free_keys(value)) (*this)(name.c_str(), value[name]);
    leave();
  }
  /// One of a fixed set of words.
  template <class E>
    requires std::is_enum_v<E>
  void choice(const char* key, E& value, std::initializer_list<std::pair<const char*, E>> names) {
    std::vector<std::string> words;
    std::string word;
    for (const auto& [name, e] : names) {
      words.emplace_back(name);
      if (e == value) word = name;
    }
    text_of(key, word, words);
    for (const auto& [name, e] : names)
      if (word == name) value = e;
  }
  /// A relation between members. When loading, a false `ok` is an error at `key` (or at the mapping).
  virtual void check(bool ok, const char* key, const std::string& expected) = 0;
  /// `base: NAME` at this place loads the library file of that kind into `self` first; call it before any
  /// other member. A path that ends in .yaml is taken relative to the file that names it.
  template <class T>
  void base(const char* kind, T& self) {
    load_base(kind, [&self](Fields& f) { self.fields(f); });
  }
  virtual bool loading() const = 0;
  /// Folder of the file being loaded (for paths inside it); empty when saving.
  virtual std::filesystem::path folder() const { return {}; }

 protected:
  virtual void number(const char* key, double& value, Range range) = 0;
  virtual void number_or_automatic(const char* key, std::optional<double>& value, Range range) = 0;
  virtual void integer(const char* key, int64_t& value, Range range) = 0;
  virtual void unsigned_integer(const char* key, uint64_t& value) = 0;
  virtual void boolean(const char* key, bool& value) = 0;
  virtual void text(const char* key, std::string& value) = 0;
  virtual void text_of(const char* key, std::string& value, const std::vector<std::string>& words) = 0;
  virtual void numbers(const char* key, double* values, size_t count, Range range) = 0;
  virtual bool enter(const char* key, bool worth_saving) = 0;
  virtual bool enter_optional(const char* key, bool present) = 0;
  virtual bool enter_list(const char* key, size_t& size) = 0;
  virtual void enter_item(size_t index) = 0;
  virtual void leave() = 0;
  virtual void item(size_t index, double& value) = 0;
  virtual void item(size_t index, std::string& value) = 0;
  virtual void item(size_t index, uint64_t& value) = 0;
  virtual std::vector<std::string> keys_here() = 0;
  virtual void load_base(const char* kind, const std::function<void(Fields&)>& load) = 0;

 private:
  template <class T>
  std::vector<std::string> free_keys(const std::map<std::string, T>& value) {
    if (loading()) return keys_here();
    std::vector<std::string> keys;
    for (const auto& [name, unused] : value) keys.push_back(name);
    return keys;
  }
};

/// One `--set path=value`. The path may be any unambiguous tail of the full path, as in
/// sensors.lidar.range_sigma_m for rig.sensors.lidar.range_sigma_m; list items are numbers from 0.
struct Override {
  std::string path, value;
  /// From "path=value"; throws InputError.
  static Override parse(std::string_view text);
};

namespace config_detail {
void load_file(const std::filesystem::path& path, const Library& library, const std::vector<Override>& overrides,
               const std::function<void(Fields&)>& visit);
void load_text(std::string_view yaml, const std::string& name, const Library& library,
               const std::vector<Override>& overrides, const std::function<void(Fields&)>& visit);
std::string save(const std::function<void(Fields&)>& visit);
}  // namespace config_detail

/// Loads a YAML file over the values that `config` holds. Throws InputError. `config` is left as it was on error.
template <class T>
void load_config(const std::filesystem::path& path, T& config, const Library& library = {},
                 const std::vector<Override>& overrides = {}) {
  T loaded = config;
  config_detail::load_file(path, library, overrides, [&](Fields& f) { loaded.fields(f); });
  config = std::move(loaded);
}
/// The same for a text; `name` stands for the file in messages.
template <class T>
void load_config_text(std::string_view yaml, const std::string& name, T& config, const Library& library = {},
                      const std::vector<Override>& overrides = {}) {
  T loaded = config;
  config_detail::load_text(yaml, name, library, overrides, [&](Fields& f) { loaded.fields(f); });
  config = std::move(loaded);
}
/// YAML of all members. Loading it gives the same values to the bit.
template <class T>
std::string save_config(const T& config) {
  T copy = config;
  return config_detail::save([&](Fields& f) { copy.fields(f); });
}

/// The candidate with the smallest edit distance to `word`, or "" if none is near (at most a third of its length).
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace vsslam

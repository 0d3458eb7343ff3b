// Comma-separated tables with one header line. Reading says file:line of what is wrong; writing is the same,
// byte for byte, for the same values.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/se3.h"

namespace vsslam {

/// Builds a table row by row: one call per field, then end_row(). A row of the wrong length is our own bug
/// and throws std::logic_error.
class CsvWriter {
 public:
  explicit CsvWriter(std::span<const char* const> columns);

  CsvWriter& operator()(
      double value);  ///< shortest text that reads back to the same double; NaN: empty field
  CsvWriter& operator()(std::integral auto value) { return integer(static_cast<int64_t>(value)); }
  CsvWriter& operator()(std::string_view text);  ///< quoted where it must be
  CsvWriter& operator()(const char* text) { return (*this)(std::string_view(text)); }
  CsvWriter& operator()(Time stamp);       ///< seconds with nine decimals
  CsvWriter& operator()(const Vec3& v);    ///< three fields
  CsvWriter& operator()(const SE3& pose);  ///< x y z qx qy qz qw, qw >= 0
  CsvWriter& empty(size_t fields = 1);
  void end_row();

  const std::string& text() const { return text_; }

 private:
  CsvWriter& integer(int64_t value);
  void separate();

  size_t columns_, fields_ = 0;
  std::string text_;
};

/// A table in memory. Fields are text; typed access throws InputError with file:line and the column.
class CsvTable {
 public:
  /// Throws InputError: no header, a row with the wrong number of fields, an open quote, a repeated column.
  static CsvTable read(const std::filesystem::path& path);
  static CsvTable parse(std::string_view text, const std::string& name);

  size_t rows() const { return lines_.size(); }
  bool has(std::string_view column) const { return find(column).has_value(); }
  /// Throws InputError that names the missing columns.
  void require(std::span<const char* const> columns) const;

  const std::string& text(size_t row, std::string_view column) const;
  bool empty(size_t row, std::string_view column) const { return text(row, column).empty(); }
  double number(size_t row, std::string_view column) const;                       ///< finite
  std::optional<double> maybe_number(size_t row, std::string_view column) const;  ///< nullopt: empty field
  int64_t integer(size_t row, std::string_view column) const;

 private:
  std::optional<size_t> find(std::string_view column) const;
  size_t index(std::string_view column) const;
  [[noreturn]] void fail(size_t row, std::string_view column, std::string_view expected) const;

  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::string> fields_;  // row after row
  std::vector<size_t> lines_;        // line of each row, from 1
};

/// Seconds as text, to the nanosecond and without a detour through double. nullopt: not a number or too
/// large.
std::optional<Time> parse_seconds(std::string_view text);
std::string format_seconds(Time stamp);
/// A whole field as a finite double; nullopt otherwise.
std::optional<double> parse_number(std::string_view text);

}  // namespace vsslam

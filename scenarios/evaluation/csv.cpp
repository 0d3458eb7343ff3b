#include "scenarios/evaluation/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/errors.h"
#include "core/files.h"

namespace vsslam {

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<Time> parse_seconds(std::string_view text) {
  const auto seconds = parse_number(text);
  if (!seconds || std::abs(*seconds) > 9e9) return std::nullopt;
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text.find_first_of("eE") != std::string_view::npos) return Time::from_seconds(*seconds);

  const size_t point = std::min(text.find('.'), text.size());
  int64_t ns = 0;
  for (const char digit : text.substr(0, point)) ns = ns * 10 + (digit - '0');
  const std::string_view fraction = point < text.size() ? text.substr(point + 1) : std::string_view();
  for (size_t i = 0; i < 9; ++i) ns = ns * 10 + (i < fraction.size() ? fraction[i] - '0' : 0);
  if (fraction.size() > 9 && fraction[9] >= '5') ++ns;
  return Time{negative ? -ns : ns};
}

std::string format_seconds(Time stamp) {
  const auto magnitude = stamp.ns < 0 ? 0 - static_cast<uint64_t>(stamp.ns) : static_cast<uint64_t>(stamp.ns);
  return fmt::format("{}{}.{:09}", stamp.ns < 0 ? "-" : "", magnitude / 1'000'000'000,
                     magnitude % 1'000'000'000);
}

CsvWriter::CsvWriter(std::span<const char* const> columns) : columns_(columns.size()) {
  for (const char* column : columns) (*this)(column);
  end_row();
}

void CsvWriter::separate() {
  if (fields_++ > 0) text_ += ',';
}

CsvWriter& CsvWriter::operator()(double value) {
  separate();
  if (!std::isnan(value)) fmt::format_to(std::back_inserter(text_), "{}", value == 0 ? 0.0 : value);
  return *this;
}

CsvWriter& CsvWriter::integer(int64_t value) {
  separate();
  fmt::format_to(std::back_inserter(text_), "{}", value);
  return *this;
}

CsvWriter& CsvWriter::operator()(std::string_view text) {
  separate();
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    text_ += text;
    return *this;
  }
  text_ += '"';
  for (const char c : text) {
    if (c == '"') text_ += '"';
    text_ += c;
  }
  text_ += '"';
  return *this;
}

CsvWriter& CsvWriter::operator()(Time stamp) {
  separate();
  text_ += format_seconds(stamp);
  return *this;
}

CsvWriter& CsvWriter::operator()(const Vec3& v) {
  return (*this)(v.x())(v.y())(v.z());
}

CsvWriter& CsvWriter::operator()(const SE3& pose) {
  const Quat& q = pose.rotation;
  const double sign = q.w() < 0 ? -1 : 1;
  return (*this)(pose.translation)(sign * q.x())(sign * q.y())(sign * q.z())(sign * q.w());
}

CsvWriter& CsvWriter::empty(size_t fields) {
  for (size_t i = 0; i < fields; ++i) separate();
  return *this;
}

void CsvWriter::end_row() {
  if (fields_ != columns_)
    throw std::logic_error(fmt::format("a CSV row of {} fields for {} columns", fields_, columns_));
  fields_ = 0;
  text_ += '\n';
}

namespace {

/// Cuts a text into records of fields, with quotes as in RFC 4180.
class CsvScanner {
 public:
  CsvScanner(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool at_end() const { return at_ >= text_.size(); }
  size_t line() const { return line_; }

  std::vector<std::string> record() {
    std::vector<std::string> fields(1);
    while (!at_end()) {
      const char c = text_[at_++];
      if (c == '\n') {
        ++line_;
        break;
      }
      if (c == ',')
        fields.emplace_back();
      else if (c == '"' && fields.back().empty())
        quoted(fields.back());
      else if (c != '\r')
        fields.back() += c;
    }
    return fields;
  }

 private:
  void quoted(std::string& field) {
    const size_t opened = line_;
    while (!at_end()) {
      const char c = text_[at_++];
      if (c == '\n') ++line_;
      if (c == '"') {
        if (at_end() || text_[at_] != '"') return;
        ++at_;
      }
      field += c;
    }
    throw InputError(fmt::format("{}:{}: a quoted field that does not end", name_, opened));
  }

  std::string_view text_;
  const std::string& name_;
  size_t at_ = 0, line_ = 1;
};

}  // namespace

CsvTable CsvTable::read(const std::filesystem::path& path) {
  return parse(read_file(path), path.string());
}

CsvTable CsvTable::parse(std::string_view text, const std::string& name) {
  CsvTable table;
  table.name_ = name;
  CsvScanner scanner(text, table.name_);
  if (text.empty()) throw InputError(fmt::format("{}:1: empty, expected a header line", name));
  table.columns_ = scanner.record();
  for (auto column = table.columns_.begin(); column != table.columns_.end(); ++column)
    if (std::find(table.columns_.begin(), column, *column) != column)
      throw InputError(fmt::format("{}:1: column \"{}\" appears twice", name, *column));
  while (!scanner.at_end()) {
    const size_t line = scanner.line();
    std::vector<std::string> fields = scanner.record();
    if (fields.size() == 1 && fields[0].empty()) continue;
    if (fields.size() != table.columns_.size())
      throw InputError(
          fmt::format("{}:{}: {} fields, expected {}", name, line, fields.size(), table.columns_.size()));
    std::move(fields.begin(), fields.end(), std::back_inserter(table.fields_));
    table.lines_.push_back(line);
  }
  return table;
}

std::optional<size_t> CsvTable::find(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) return std::nullopt;
  return static_cast<size_t>(found - columns_.begin());
}

size_t CsvTable::index(std::string_view column) const {
  const auto found = find(column);
  if (!found) throw InputError(fmt::format("{}:1: no column \"{}\"", name_, column));
  return *found;
}

void CsvTable::require(std::span<const char* const> columns) const {
  std::string missing;
  for (const char* column : columns)
    if (!has(column)) missing += fmt::format("{}\"{}\"", missing.empty() ? "" : ", ", column);
  if (!missing.empty()) throw InputError(fmt::format("{}:1: missing columns: {}", name_, missing));
}

const std::string& CsvTable::text(size_t row, std::string_view column) const {
  return fields_.at(row * columns_.size() + index(column));
}

void CsvTable::fail(size_t row, std::string_view column, std::string_view expected) const {
  throw InputError(fmt::format("{}:{}: column \"{}\": expected {}, found \"{}\"", name_, lines_.at(row),
                               column, expected, text(row, column)));
}

double CsvTable::number(size_t row, std::string_view column) const {
  const auto value = parse_number(text(row, column));
  if (!value) fail(row, column, "a number");
  return *value;
}

std::optional<double> CsvTable::maybe_number(size_t row, std::string_view column) const {
  if (empty(row, column)) return std::nullopt;
  return number(row, column);
}

int64_t CsvTable::integer(size_t row, std::string_view column) const {
  const std::string& field = text(row, column);
  int64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) fail(row, column, "an integer");
  return value;
}

}  // namespace vsslam

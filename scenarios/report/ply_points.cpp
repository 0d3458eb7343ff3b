#include "scenarios/report/ply_points.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/evaluation/csv.h"

namespace vsslam {

namespace {

enum class Scalar { int8, int16, int32, float32, float64 };

std::optional<Scalar> scalar_type(std::string_view name) {
  if (name == "char" || name == "uchar" || name == "int8" || name == "uint8") return Scalar::int8;
  if (name == "short" || name == "ushort" || name == "int16" || name == "uint16") return Scalar::int16;
  if (name == "int" || name == "uint" || name == "int32" || name == "uint32") return Scalar::int32;
  if (name == "float" || name == "float32") return Scalar::float32;
  if (name == "double" || name == "float64") return Scalar::float64;
  return std::nullopt;
}

size_t size_of(Scalar type) {
  constexpr std::array<size_t, 5> kSizes = {1, 2, 4, 4, 8};
  return kSizes[static_cast<size_t>(type)];
}

struct Column {
  size_t index = 0, offset = 0;  // among the words of a line, and in bytes
  std::optional<Scalar> type;
};

struct Header {
  bool ascii = false;
  size_t vertices = 0, columns = 0, stride = 0;
  std::array<Column, 3> xyz;
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, std::string name) : rest_(bytes), name_(std::move(name)) {}

  Cloud points() {
    const Header header = read_header();
    // Every vertex takes at least one byte of the file, so a count beyond that is a broken header.
    if (header.vertices > rest_.size())
      fail(fmt::format("{} vertices announced, {} bytes left", header.vertices, rest_.size()));
    Cloud cloud;
    cloud.reserve(header.vertices);
    for (size_t i = 0; i < header.vertices; ++i) {
      cloud.push_back(header.ascii ? ascii_vertex(header) : binary_vertex(header));
      if (!cloud.back().allFinite()) fail(fmt::format("vertex {} is not finite", i));
    }
    return cloud;
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(line_ > 0 ? fmt::format("{}:{}: {}", name_, line_, what)
                               : fmt::format("{}: {}", name_, what));
  }

  std::string_view line() {
    if (rest_.empty()) fail("ends too early");
    const size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (text.ends_with('\r')) text.remove_suffix(1);
    ++line_;
    return text;
  }

  static std::vector<std::string_view> words(std::string_view text) {
    std::vector<std::string_view> result;
    for (size_t at = text.find_first_not_of(" \t"); at != text.npos;) {
      const size_t end = std::min(text.find_first_of(" \t", at), text.size());
      result.push_back(text.substr(at, end - at));
      at = text.find_first_not_of(" \t", end);
    }
    return result;
  }

  Header read_header() {
    if (line() != "ply") fail("not a PLY file");
    Header header;
    bool in_vertex = false, seen_vertex = false, seen_format = false;
    for (auto word = words(line()); word.empty() || word[0] != "end_header"; word = words(line())) {
      if (word.size() >= 2 && word[0] == "format") {
        header.ascii = word[1] == "ascii";
        seen_format = header.ascii || word[1] == "binary_little_endian";
        if (!seen_format) fail(fmt::format("format {} is not supported", word[1]));
      } else if (word.size() >= 3 && word[0] == "element") {
        in_vertex = word[1] == "vertex";
        if (!in_vertex && !seen_vertex) fail("expected \"vertex\" as the first element");
        if (in_vertex) header.vertices = vertex_count(word[2]);
        seen_vertex |= in_vertex;
      } else if (word.size() >= 3 && word[0] == "property" && in_vertex) {
        add_property(header, word[1], word[2]);
      }
    }
    if (!seen_format) fail("no format line");
    for (const Column& column : header.xyz)
      if (!column.type) fail("vertices without x, y and z");
    return header;
  }

  size_t vertex_count(std::string_view text) const {
    size_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size()) fail(fmt::format("\"{}\" vertices", text));
    return count;
  }

  void add_property(Header& header, std::string_view type_name, std::string_view name) const {
    const auto type = scalar_type(type_name);
    if (!type) fail(fmt::format("vertex property of type {} is not supported", type_name));
    for (size_t axis = 0; axis < 3; ++axis)
      if (name == std::string_view("xyz").substr(axis, 1)) {
        if (*type != Scalar::float32 && *type != Scalar::float64) fail(fmt::format("{} must be float", name));
        header.xyz[axis] = {header.columns, header.stride, type};
      }
    ++header.columns;
    header.stride += size_of(*type);
  }

  Eigen::Vector3f ascii_vertex(const Header& header) {
    const auto word = words(line());
    if (word.size() < header.columns)
      fail(fmt::format("{} values, expected {}", word.size(), header.columns));
    Eigen::Vector3f point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = parse_number(word[header.xyz[static_cast<size_t>(axis)].index]);
      if (!value) fail("expected finite coordinates");
      point[axis] = static_cast<float>(*value);
    }
    return point;
  }

  Eigen::Vector3f binary_vertex(const Header& header) {
    line_ = 0;
    if (rest_.size() < header.stride) fail("ends within its vertices");
    Eigen::Vector3f point;
    for (int axis = 0; axis < 3; ++axis) {
      const Column& column = header.xyz[static_cast<size_t>(axis)];
      if (*column.type == Scalar::float32) {
        std::memcpy(&point[axis], rest_.data() + column.offset, sizeof(float));
      } else {
        double value = 0;
        std::memcpy(&value, rest_.data() + column.offset, sizeof value);
        point[axis] = static_cast<float>(value);
      }
    }
    rest_.remove_prefix(header.stride);
    return point;
  }

  std::string_view rest_;
  std::string name_;
  size_t line_ = 0;
};

}  // namespace

Cloud read_ply_points(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return PlyReader(bytes, path.string()).points();
}

}  // namespace vsslam

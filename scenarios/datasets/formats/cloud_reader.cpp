#include "scenarios/datasets/formats/cloud_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/files.h"

namespace vsslam {

namespace {

using Field = PointCloudMessage::Field;

// More than any LiDAR gives in a revolution.
constexpr size_t kMostBytes = size_t{1} << 30;

void take_data(PointCloudMessage& cloud, std::string_view data) {
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.assign(data.begin(), data.begin() + cloud.row_step);
}

void scale_reflectance(std::vector<uint8_t>& data) {
  float most = 0;
  const auto each = [&](const auto& use) {
    for (size_t at = 12; at + 4 <= data.size(); at += 16) {
      float value;
      std::memcpy(&value, &data[at], 4);
      use(value, at);
    }
  };
  each([&](float value, size_t) { most = std::max(most, value); });
  if (most > 1) return;
  each([&](float value, size_t at) {
    value *= 255;
    std::memcpy(&data[at], &value, 4);
  });
}

uint8_t datatype(char kind, int bytes) {
  const std::map<std::pair<char, int>, uint8_t> types = {
      {{'I', 1}, Field::i8},  {{'U', 1}, Field::u8},  {{'I', 2}, Field::i16}, {{'U', 2}, Field::u16},
      {{'I', 4}, Field::i32}, {{'U', 4}, Field::u32}, {{'F', 4}, Field::f32}, {{'F', 8}, Field::f64}};
  const auto found = types.find({kind, bytes});
  return found == types.end() ? uint8_t{0} : found->second;
}

struct PcdHeader {
  std::map<std::string, std::vector<std::string>> lines;
  size_t end = 0;

  const std::vector<std::string>& words(const char* key, const std::filesystem::path& path) const {
    const auto found = lines.find(key);
    if (found == lines.end() || found->second.empty())
      throw InputError(fmt::format("{}: a PCD file without {}", path.string(), key));
    return found->second;
  }
};

PcdHeader pcd_header(const std::string& content, const std::filesystem::path& path) {
  PcdHeader header;
  while (!header.lines.contains("DATA")) {
    const size_t end = content.find('\n', header.end);
    if (end == std::string::npos)
      throw InputError(fmt::format("{}: no PCD file: no line DATA", path.string()));
    std::istringstream line(content.substr(header.end, end - header.end));
    std::string key, word;
    line >> key;
    while (line >> word) header.lines[key].push_back(word);
    if (key == "DATA") header.lines[key];
    header.end = end + 1;
  }
  return header;
}

int number(const std::string& text, const std::filesystem::path& path) {
  try {
    const int value = std::stoi(text);
    if (value >= 0) return value;
  } catch (const std::exception&) {
  }
  throw InputError(fmt::format("{}: expected a whole number in the header, got {}", path.string(), text));
}

}  // namespace

PointCloudMessage read_kitti_cloud(const std::filesystem::path& path) {
  const std::string content = read_file(path, kMostBytes);
  if (content.size() % 16 != 0)
    throw InputError(
        fmt::format("{}: expected points of 16 bytes, got {} bytes", path.string(), content.size()));
  PointCloudMessage cloud;
  cloud.fields = {{"x", 0, Field::f32, 1},
                  {"y", 4, Field::f32, 1},
                  {"z", 8, Field::f32, 1},
                  {"intensity", 12, Field::f32, 1}};
  cloud.point_step = 16;
  cloud.width = static_cast<uint32_t>(content.size() / 16);
  take_data(cloud, content);
  scale_reflectance(cloud.data);
  return cloud;
}

PointCloudMessage read_pcd_cloud(const std::filesystem::path& path) {
  const std::string content = read_file(path, kMostBytes);
  const PcdHeader header = pcd_header(content, path);
  const auto& names = header.words("FIELDS", path);
  const auto& sizes = header.words("SIZE", path);
  const auto& kinds = header.words("TYPE", path);
  if (header.words("DATA", path)[0] != "binary")
    throw InputError(fmt::format("{}: only binary, uncompressed PCD files are read", path.string()));
  if (sizes.size() != names.size() || kinds.size() != names.size())
    throw InputError(fmt::format("{}: FIELDS, SIZE and TYPE differ in length", path.string()));
  const auto counts = header.lines.find("COUNT");
  PointCloudMessage cloud;
  for (size_t i = 0; i < names.size(); ++i) {
    const int bytes = number(sizes[i], path);
    const int count =
        counts != header.lines.end() && i < counts->second.size() ? number(counts->second[i], path) : 1;
    cloud.fields.push_back(
        {names[i], cloud.point_step, datatype(kinds[i][0], bytes), static_cast<uint32_t>(count)});
    cloud.point_step += static_cast<uint32_t>(bytes * count);
  }
  cloud.width = static_cast<uint32_t>(number(header.words("POINTS", path)[0], path));
  const size_t left = content.size() - header.end;
  if (uint64_t{cloud.width} * cloud.point_step > left)
    throw InputError(fmt::format("{}: expected {} points of {} bytes, got {} bytes", path.string(),
                                 cloud.width, cloud.point_step, left));
  take_data(cloud, std::string_view(content).substr(header.end));
  return cloud;
}

}  // namespace vsslam

#include "scenarios/datasets/formats/cloud_files.h"

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "scenarios/datasets/messages/sample_messages.h"

namespace vsslam {

namespace {

// Every column: name, bytes, PCD's type.
struct Column {
  const char* name;
  int bytes;
  char type;
};

std::string pcd_header(std::span<const Column> columns, size_t points) {
  std::string names, sizes, types, counts;
  for (const Column& column : columns) {
    names += fmt::format(" {}", column.name);
    sizes += fmt::format(" {}", column.bytes);
    types += fmt::format(" {}", column.type);
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS{}\nSIZE{}\nTYPE{}\nCOUNT{}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      names, sizes, types, counts, points, points);
}

constexpr std::array<Column, 6> kScanColumns = {
    {{"x", 4, 'F'}, {"y", 4, 'F'}, {"z", 4, 'F'}, {"intensity", 4, 'F'}, {"ring", 2, 'U'}, {"time", 4, 'F'}}};
constexpr std::array<Column, 11> kTruthColumns = {{{"x", 4, 'F'},
                                                   {"y", 4, 'F'},
                                                   {"z", 4, 'F'},
                                                   {"normal_x", 4, 'F'},
                                                   {"normal_y", 4, 'F'},
                                                   {"normal_z", 4, 'F'},
                                                   {"range", 4, 'F'},
                                                   {"cos_incidence", 4, 'F'},
                                                   {"object", 4, 'U'},
                                                   {"triangle", 4, 'U'},
                                                   {"material", 4, 'U'}}};

void append_packed(std::string& bytes, const LidarScan& scan) {
  const PointCloudMessage cloud = cloud_message(scan, "");
  bytes.append(reinterpret_cast<const char*>(cloud.data.data()), cloud.data.size());
}

template <class... Values>
void append(std::string& bytes, Values... values) {
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
}

}  // namespace

std::string pcd_of_scan(const LidarScan& scan) {
  std::string bytes = pcd_header(kScanColumns, scan.points.size());
  append_packed(bytes, scan);
  return bytes;
}

std::string ply_of_scan(const LidarScan& scan) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nproperty float intensity\nproperty ushort ring\nproperty float time\nend_header\n",
      scan.points.size());
  append_packed(bytes, scan);
  return bytes;
}

std::string kitti_of_scan(const LidarScan& scan) {
  std::string bytes;
  bytes.reserve(16 * scan.points.size());
  for (const LidarPoint& p : scan.points) append(bytes, p.x, p.y, p.z, p.intensity / 255.0f);
  return bytes;
}

std::string pcd_of_truth(std::span<const PointTruth> truth) {
  std::string bytes = pcd_header(kTruthColumns, truth.size());
  for (const PointTruth& p : truth) {
    append(bytes, p.position_lidar.x(), p.position_lidar.y(), p.position_lidar.z(), p.normal_lidar.x(),
           p.normal_lidar.y(), p.normal_lidar.z(), p.range_m, p.cos_incidence);
    append(bytes, p.object, p.triangle, uint32_t{p.material});
  }
  return bytes;
}

std::string pcd_of_twins(std::span<const PointTruth> truth) {
  std::string bytes = pcd_header(std::span(kTruthColumns).first(3), truth.size());
  for (const PointTruth& p : truth)
    append(bytes, p.position_lidar.x(), p.position_lidar.y(), p.position_lidar.z());
  return bytes;
}

std::string labels_of(std::span<const PointTruth> truth) {
  std::string bytes;
  for (const PointTruth& p : truth) append(bytes, uint32_t{p.material} | p.object << 16);
  return bytes;
}

}  // namespace vsslam

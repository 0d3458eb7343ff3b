#include "scenarios/stages/descriptor_example.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "slam/loop/scan_context.h"

namespace vsslam {

namespace {

constexpr size_t kMostPoints = 4000;

int centimetres(float metres) {
  return static_cast<int>(std::lround(100 * metres));
}

nlohmann::ordered_json points_json(const Cloud& points_lidar, double max_range_m) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const size_t stride = (points_lidar.size() / kMostPoints) | 1;  // odd, so that no laser is left out
  for (size_t i = 0; i < points_lidar.size(); i += stride)
    if (points_lidar[i].head<2>().norm() <= max_range_m)
      for (int axis = 0; axis < 3; ++axis) list.push_back(centimetres(points_lidar[i][axis]));
  return list;
}

nlohmann::ordered_json heights_json(const PolarHeights& heights) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) list.push_back(centimetres(heights(ring, sector)));
  return list;
}

}  // namespace

void DescriptorExample::add(const OdometryScan& scan, const ScanReport& report) {
  if (!report.memory || scans_[2]) return;
  Scan now{report.key, report.scan, report.memory->stored(), scan.points_lidar};
  if (now.stored) {
    const bool complete = scans_[1].has_value();
    scans_[complete ? 2 : 0] = std::move(now);
  } else if (report.memory->distinct && scans_[0] && !scans_[1]) {
    scans_[1] = std::move(now);
  }
}

std::string DescriptorExample::json(double mount_height_m, const ScanContextConfig& config) const {
  if (!scans_[1]) return {};
  nlohmann::ordered_json scans = nlohmann::ordered_json::array();
  std::optional<ScanContext> first;
  for (const auto& scan : scans_) {
    if (!scan) continue;
    const PolarHeights heights = polar_heights(*scan->points_lidar, mount_height_m, config);
    const ScanContext context(heights);
    if (!first) first = context;
    scans.push_back({{"key", scan->key},
                     {"scan", scan->scan},
                     {"stored", scan->stored},
                     {"distance", scan_context_distance(context, *first).distance},
                     {"heights_cm", heights_json(heights)},
                     {"points_lidar_cm", points_json(*scan->points_lidar, config.max_range_m)}});
  }
  const nlohmann::ordered_json json = {{"max_range_m", config.max_range_m}, {"scans", scans}};
  return json.dump() + "\n";
}

}  // namespace vsslam

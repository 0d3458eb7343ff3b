// SLAM systems that a dataset can be made for: names of topics, formats, and the system's own configuration with the
// rig's true numbers in it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/datasets/facts/dataset_facts.h"

namespace vsslam {

enum class DatasetFormat { bag, mcap, euroc, kitti, pcd, ply, tum };
/// "bag", "mcap", ...
std::string_view format_name(DatasetFormat format);
/// Throws InputError with the nearest name.
DatasetFormat parse_format(std::string_view name);

/// A file of a dataset beside its measurements.
struct ExtraFile {
  std::string path;  ///< in the dataset's folder
  std::string content;
};

struct TargetSystem {
  std::string name;   ///< as on the command line
  std::string title;  ///< as its authors write it
  DatasetFormat format;
  bool camera;       ///< it cannot do without
  bool orientation;  ///< it cannot do without that of the IMU
  MessageNames names;
  std::vector<ExtraFile> (*configuration)(const DatasetFacts& facts);
  /// Markdown: how to start it on the dataset, which lies in the current folder.
  std::string (*instructions)(const DatasetFacts& facts);
  std::optional<Vec3> imu_rpy_deg =
      std::nullopt;  ///< the only mount of the IMU in the base that its code allows
};

const std::vector<TargetSystem>& target_systems();
/// Throws InputError with the nearest name.
const TargetSystem& target_system(std::string_view name);

}  // namespace vsslam

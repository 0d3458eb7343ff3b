// The files of one result, read and checked.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "slam/lidar/cloud.h"

namespace vsslam {

struct StoredResult {
  std::filesystem::path path;
  std::string scenario, method;                   ///< as metrics.json says
  std::string seed;                               ///< likewise; empty for a recording
  std::shared_ptr<const nlohmann::json> metrics;  ///< an object
  std::shared_ptr<const nlohmann::json> timing;   ///< an object, or null without timing.json
  PoseTrajectory truth;                           ///< T_world_base; empty without truth.tum
  PoseTrajectory estimate;                        ///< T_map_base
  PoseTrajectory odometry;                        ///< T_odom_base; empty without odometry.tum
  std::optional<CsvTable> scans, loops, descriptors;
  std::optional<Cloud> points_map;
  std::string camera_png;                         ///< empty without camera.png

  bool has_truth() const { return !truth.empty(); }
  std::string name() const { return scenario + " · " + method + (seed.empty() ? "" : " · seed " + seed); }
};

/// Throws InputError that names the file: missing (only the needed ones), empty or broken.
StoredResult read_stored_result(const std::filesystem::path& path);

}  // namespace vsslam

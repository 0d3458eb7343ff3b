// KISS-ICP (Vizzo et al., RA-L 2023), github.com/PRBonn/kiss-icp. Keys: its config/advanced.yaml.
#include <fmt/format.h>

#include "scenarios/datasets/configuration_text.h"
#include "scenarios/datasets/target_configurations.h"

namespace vsslam {

namespace {

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  return {{"kiss_icp.yaml",
           fmt::format("# KISS-ICP's parameters for this dataset; the rest are its defaults.\n"
                       "out_dir: \"results\"\n\ndata:\n  deskew: True\n  max_range: {}\n  min_range: {}\n\n"
                       "mapping:\n  max_points_per_voxel: 20\n",
                       real_text(facts.rig.lidar.max_range_m), real_text(facts.rig.lidar.min_range_m))}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "    pip install \"kiss-icp[all]\"\n"
      "    kiss_icp_pipeline --config kiss_icp.yaml --topic {} {}.bag\n\n"
      "Do not use its `kitti` loader on the `velodyne/` folder of an export: it corrects the vertical angles "
      "of KITTI's "
      "own HDL-64, which these scans do not need, and there are no times of points to deskew with. The pose "
      "is the "
      "LiDAR's; `truth.tum` is the base's.\n",
      facts.names.points, facts.scenario.name);
}

}  // namespace

TargetSystem kiss_icp() {
  return {"kiss-icp", "KISS-ICP", DatasetFormat::bag, false, false, {}, configuration, instructions};
}

}  // namespace vsslam

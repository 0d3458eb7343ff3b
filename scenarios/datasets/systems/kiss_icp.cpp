// KISS-ICP (Vizzo et al., RA-L 2023), github.com/PRBonn/kiss-icp. Keys: its config/advanced.yaml.
#include <fmt/format.h>

#include "scenarios/datasets/systems/configuration_text.h"
#include "scenarios/datasets/systems/target_configurations.h"

namespace vsslam {

namespace {

// Left to itself it takes a hundredth of the range, 1 m for a VLP-16: too coarse for a corridor 2.4 m wide.
double voxel_size_m(const DatasetFacts& facts) {
  return 2.5 * leaf_size_m(facts);
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  return {
      {"kiss_icp.yaml",
       fmt::format("# KISS-ICP's parameters for this dataset; the rest are its defaults.\n"
                   "out_dir: \"results\"\n\ndata:\n  deskew: True\n  max_range: {}\n  min_range: {}\n\n"
                   "mapping:\n  voxel_size: {}  # m; 0.5 indoors, 1 outdoors\n  max_points_per_voxel: 20\n",
                   real_text(facts.rig.lidar.max_range_m), real_text(facts.rig.lidar.min_range_m),
                   real_text(voxel_size_m(facts)))}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "    pip install \"kiss-icp[all]>=1.2\" \"rosbags<0.11\"\n"
      "    kiss_icp_pipeline --config kiss_icp.yaml --topic {0} {1}.bag\n\n"
      "The poses are in `results/latest/{1}_poses_tum.txt`. Older versions do not deskew without `--deskew`; "
      "rosbags 0.11 lacks "
      "what it reads bags with. Its stamps are those of the bag, the ends of the scans, and so are its "
      "poses.\n"
      "\n"
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

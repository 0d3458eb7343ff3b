// Truth that a dataset has on request, as files in <dataset>/truth/.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"
#include "worlds/world.h"

namespace vsslam {

enum class TruthKind {
  points,  ///< of each LiDAR point: noise-free position, normal, range, incidence, object, triangle, material
  clean,   ///< noise-free, undistorted twins of the clouds; images without blur and noise
  depth,   ///< depth images
  labels,  ///< of each LiDAR point: object and material, and a table of their names
  biases,  ///< of the IMU, and the slip of the wheels
  loops,   ///< places seen again
  degeneracy,  ///< directions that the scene leaves open, scan by scan
};
/// Throws InputError with the nearest name; "camera" is not one of them.
TruthKind parse_truth(std::string_view name);
std::vector<std::string> truth_names();

/// The sinks that write them. `world` must outlive them.
std::vector<std::unique_ptr<DatasetSink>> truth_sinks(const DatasetFacts& facts, const World& world,
                                                      const std::vector<TruthKind>& kinds);
/// Markdown: what the files are.
std::string truth_description(const std::vector<TruthKind>& kinds, bool camera);

}  // namespace vsslam

#include "scenarios/oracles/aliases.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/ordered_parallel.h"

namespace vsslam {

ScanContext true_descriptor(const LidarMeasurement& measurement, double mount_height_m,
                            const ScanContextConfig& config) {
  Cloud points_lidar;
  points_lidar.reserve(measurement.truth.size());
  for (const PointTruth& point : measurement.truth) points_lidar.push_back(point.position_lidar);
  return ScanContext(polar_heights(points_lidar, mount_height_m, config));
}

std::vector<Alias> find_aliases(const LoopOracle& oracle, std::span<const ScanContext> descriptors,
                                double threshold) {
  if (descriptors.size() != oracle.keys().size())
    throw std::logic_error(
        fmt::format("{} descriptors for {} key scans", descriptors.size(), oracle.keys().size()));
  std::vector<std::vector<Alias>> found(descriptors.size());
  parallel_pieces(descriptors.size(), 1, [&](size_t begin, size_t end) {
    for (size_t query = begin; query < end; ++query)
      for (size_t match = 0; match < query; ++match) {
        const double distance = scan_context_distance(descriptors[query], descriptors[match]).distance;
        if (distance < threshold && !oracle.overlaps(static_cast<int>(query), static_cast<int>(match)))
          found[query].push_back({static_cast<int>(query), static_cast<int>(match), distance});
      }
  });
  std::vector<Alias> aliases;
  for (const auto& of_query : found) aliases.insert(aliases.end(), of_query.begin(), of_query.end());
  return aliases;
}

}  // namespace vsslam

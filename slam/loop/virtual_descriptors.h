// Virtual descriptors (Song et al. 2025, section 4.1): a query is also described as if the sensor stood aside,
// so that it finds places that were passed at a lateral offset.
#pragma once

#include <vector>

#include "slam/lidar/cloud.h"
#include "slam/loop/descriptor_database.h"
#include "slam/loop/loop_config.h"

namespace vsslam {

/// Where the sensor is imagined, in its own x-y plane: 8 directions at each of N distances; id 1 + 8 (i - 1) + j
/// for the distance M i and the direction theta_j = 45 deg * j, measured from +y (2).
std::vector<Eigen::Vector2d> virtual_offsets_m(const VirtualDescriptorConfig& config);

/// The scan's own descriptor first, then those of the 8 N virtual positions (3). The virtual ones see the
/// highest point of each column of 0.1 m only.
std::vector<QueryDescriptor> describe_query(const Cloud& points_lidar, double mount_height_m,
                                            const ScanContextConfig& scan_context,
                                            const VirtualDescriptorConfig& config);

}  // namespace vsslam

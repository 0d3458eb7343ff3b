// The order of points that consumers of datasets expect: column by column, within a column by ring.
#pragma once

#include "sensors/lidar/laser_table.h"
#include "sensors/measurement/samples.h"

namespace vsslam {

/// Sorts the points of each firing cycle by ring, the lowest first, and their truth with them. Of a device whose highest
/// ring is not the last to fire the scan's last cycle stays in order of firing: the last point is always the latest.
void arrange_in_columns(LidarMeasurement& measurement, const LaserTable& table);

}  // namespace vsslam

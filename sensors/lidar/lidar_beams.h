// From firing cycles to rays: 16 adjacent cycles of one laser make one packet, so that its rays lie close.
#pragma once

#include <vector>

#include "sensors/lidar/firing_poses.h"
#include "sensors/lidar/lidar_config.h"
#include "sensors/lidar/lidar_rotation.h"
#include "sensors/ray/raycaster.h"

namespace vsslam {

constexpr int kLanes = RayPacket::kRays;
constexpr size_t kMaxLasers = 32;

/// One ray of a beam, in the housing's frame; a beam without footprint has one, along its centre.
struct SubRay {
  double cos_elevation = 1, sin_elevation = 0;
  double cos_offset = 1, sin_offset = 0;  ///< of the azimuth against the housing's
  double range_offset_m = 0;              ///< from the axis to the optical centre, along the ray
  double weight = 1;                      ///< share of the beam's energy
};

/// The beams of a model, sub-rays of each laser one after another, nearest to the centre first.
struct Beams {
  Beams(const LidarConfig& config, const LaserTable& table);
  const LaserTable& table;
  size_t lasers, sub_rays;
  std::vector<SubRay> rays;  ///< [laser * sub_rays + sub_ray]
  const SubRay& ray(size_t laser, size_t sub_ray) const { return rays[laser * sub_rays + sub_ray]; }
};

/// Up to 16 firing cycles and the motion of the LiDAR during them.
struct FiringBlock {
  size_t first = 0;  ///< cycle within the revolution
  int count = 0;     ///< cycles, 1..16; the other lanes are off
  FiringPoses poses;
};

/// Rays of one laser for a block. Lanes of closed cycles (bit set in `closed`) are off.
void make_rays(const Beams& beams, size_t laser, size_t sub_ray, const FiringBlock& block,
               const CycleAzimuths& azimuths, double max_range_m, uint32_t closed, RayPacket& rays);

struct PointPacket {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
};
/// Points of one laser from reported ranges, as a driver computes them, in the lidar frame at their firing.
void place_points(const Beams& beams, size_t laser, const FiringBlock& block, const CycleAzimuths& azimuths,
                  const float (&range_m)[kLanes], PointPacket& points);

}  // namespace vsslam

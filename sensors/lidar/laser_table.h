// What Velodyne's tables say of each laser: where it points, when it fires, from where.
//
// The optical centre lies `origin_offset_m` from the axis of rotation, and all beams cross there; a device
// reports ranges from the point where the beam's line crosses the axis, which is `dz_m` above the origin.
#pragma once

#include <cstdint>
#include <vector>

namespace vsslam {

enum class LidarModel { vlp16, vlp32c };

struct Laser {
  double elevation_rad = 0;
  double azimuth_offset_rad = 0;  ///< counter-clockwise from the housing's direction
  double dz_m = 0;                ///< height of the ray's origin on the axis
  int64_t fire_offset_ns = 0;     ///< after the start of the firing cycle
  uint16_t ring = 0;              ///< 0 = lowest elevation
};

struct LaserTable {
  std::vector<Laser> lasers;  ///< by laser id; fire_offset_ns never decreases
  int64_t cycle_ns = 55'296;  ///< one firing cycle of all lasers, recharge included
  double origin_offset_m = 0.04191;
  double range_step_m = 0.002;
  int cycles_per_block = 2;  ///< a block of a data packet reports one azimuth
  int blocks_per_packet = 12;
};

const LaserTable& laser_table(LidarModel model);

}  // namespace vsslam

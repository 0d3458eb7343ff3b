// From hits to what the receiver makes of them: echoes of a footprint, received power, and the choice of one.
#pragma once

#include <span>

#include "sensors/lidar/lidar_beams.h"

namespace vsslam {

/// The echo that each lane reports, before noise. Lanes without one have `any[i]` == 0 and zeros elsewhere.
struct alignas(64) EchoPacket {
  int any[kLanes];
  float mean_range_m[kLanes];  ///< energy-weighted over the footprint, from the axis
  float power[kLanes];         ///< albedo * cos(incidence), energy-weighted; before the 1 / range^2
  float reflectivity[kLanes];  ///< byte before noise: 0-100 diffuse, 101-255 retro-reflective
  // Truth: the sub-ray of this echo that is nearest to the beam's centre.
  float range_m[kLanes];  ///< from the axis
  float cos_incidence[kLanes];
  float x[kLanes], y[kLanes], z[kLanes];                       ///< the point in world
  float normal_x[kLanes], normal_y[kLanes], normal_z[kLanes];  ///< in world, towards the sensor
  uint32_t object[kLanes], triangle[kLanes];
  int material[kLanes];
};

/// What the receiver sees of a material.
struct Reflectance {
  float albedo = 0;
  float reflectivity_low = 0, reflectivity_gain = 100;  ///< byte = low + gain * albedo * cos(incidence)
  float power_gain = 1;                                 ///< retro-reflectors send the energy back
  bool glass = false;
};

class EchoReceiver {
 public:
  EchoReceiver(const LidarConfig& config, const World& world);
  /// Traces the beams of all lasers for a block and picks the echo of each: echoes[laser].
  void receive(const Raycaster& raycaster, const Beams& beams, const FiringBlock& block,
               const CycleAzimuths& azimuths, uint32_t closed, std::span<EchoPacket> echoes) const;

 private:
  void receive_footprint(const Raycaster& raycaster, const Beams& beams, size_t laser,
                         const FiringBlock& block, const CycleAzimuths& azimuths, uint32_t closed,
                         EchoPacket& echo) const;
  void single(const SubRay& ray, const RayPacket& rays, const HitPacket& hits, EchoPacket& echo) const;
  bool any_glass(const HitPacket& hits) const;

  LidarConfig config_;
  std::vector<Reflectance> reflectance_;  ///< by material
  bool world_has_glass_ = false;
  float merge_m_;  ///< echoes nearer than this are one
};

}  // namespace vsslam

#include "sensors/lidar_beams.h"

#include <cmath>
#include <numbers>

namespace vsslam {

namespace {

// Sub-ray k of n: a sunflower of equal areas over the ellipse of the full divergence; a Gaussian beam puts
// exp(-2 r^2) of its peak at radius r.
struct FootprintPoint {
  double horizontal, vertical, energy;
};
FootprintPoint sunflower(int k, int n) {
  const double golden_rad = std::numbers::pi * (3 - std::sqrt(5.0));
  const double radius = std::sqrt(static_cast<double>(k) / n);
  return {radius * std::cos(k * golden_rad), radius * std::sin(k * golden_rad),
          std::exp(-2 * radius * radius)};
}

}  // namespace

Beams::Beams(const LidarConfig& config, const LaserTable& t)
    : table(t), lasers(t.lasers.size()), sub_rays(static_cast<size_t>(config.sub_rays)) {
  double energy = 0;
  for (int k = 0; k < config.sub_rays; ++k) energy += sunflower(k, config.sub_rays).energy;
  for (const Laser& laser : t.lasers) {
    for (int k = 0; k < config.sub_rays; ++k) {
      const FootprintPoint point = sunflower(k, config.sub_rays);
      const double elevation =
          laser.elevation_rad + 0.5e-3 * config.divergence_vertical_mrad * point.vertical;
      const double offset = laser.azimuth_offset_rad + 0.5e-3 * config.divergence_horizontal_mrad *
                                                           point.horizontal / std::cos(laser.elevation_rad);
      rays.push_back({std::cos(elevation), std::sin(elevation), std::cos(offset), std::sin(offset),
                      t.origin_offset_m / std::cos(elevation), point.energy / energy});
    }
  }
}

namespace {

/// R(s) (c, s, 0), R(s) e_z and p(s) for each lane, in world.
struct LaneFrames {
  alignas(64) double radial[3][kLanes];
  alignas(64) double up[3][kLanes];
  alignas(64) double position[3][kLanes];
};

void lane_frames(const FiringPoses& poses, const double (&cosine)[kLanes], const double (&sine)[kLanes],
                 const double (&s)[kLanes], LaneFrames& out) {
  for (int k = 0; k < 3; ++k) {
    const double x0 = poses.R_world_lidar[0](k, 0), x1 = poses.R_world_lidar[1](k, 0),
                 x2 = poses.R_world_lidar[2](k, 0);
    const double y0 = poses.R_world_lidar[0](k, 1), y1 = poses.R_world_lidar[1](k, 1),
                 y2 = poses.R_world_lidar[2](k, 1);
    const double z0 = poses.R_world_lidar[0](k, 2), z1 = poses.R_world_lidar[1](k, 2),
                 z2 = poses.R_world_lidar[2](k, 2);
    const double p0 = poses.p_world_lidar[0][k], p1 = poses.p_world_lidar[1][k],
                 p2 = poses.p_world_lidar[2][k];
    for (int i = 0; i < kLanes; ++i) {
      out.radial[k][i] =
          (x0 + s[i] * (x1 + s[i] * x2)) * cosine[i] + (y0 + s[i] * (y1 + s[i] * y2)) * sine[i];
      out.up[k][i] = z0 + s[i] * (z1 + s[i] * z2);
      out.position[k][i] = p0 + s[i] * (p1 + s[i] * p2);
    }
  }
}

}  // namespace

void make_rays(const Beams& beams, size_t laser, size_t sub_ray, const FiringBlock& block,
               const CycleAzimuths& azimuths, double max_range_m, uint32_t closed, RayPacket& rays) {
  const SubRay& ray = beams.ray(laser, sub_ray);
  const auto cycle_ns = static_cast<double>(beams.table.cycle_ns);
  const auto fire_ns = static_cast<double>(beams.table.lasers[laser].fire_offset_ns);
  alignas(64) double cosine[kLanes], sine[kLanes], s[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const size_t cycle = block.first + static_cast<size_t>(i < block.count ? i : 0);
    // Azimuth at the start of the cycle, turned on by a small angle a (error a^5 / 120).
    const double a = azimuths.actual.step_rad[cycle] * (fire_ns / cycle_ns), a2 = a * a;
    const double ca = 1 - a2 / 2 * (1 - a2 / 12), sa = a * (1 - a2 / 6);
    const double c = azimuths.actual.cosine[cycle] * ca - azimuths.actual.sine[cycle] * sa;
    const double n = azimuths.actual.sine[cycle] * ca + azimuths.actual.cosine[cycle] * sa;
    cosine[i] = c * ray.cos_offset - n * ray.sin_offset;
    sine[i] = n * ray.cos_offset + c * ray.sin_offset;
    s[i] = (i * cycle_ns + fire_ns - block.poses.mid_ns) / block.poses.half_ns;
  }
  LaneFrames lanes;
  lane_frames(block.poses, cosine, sine, s, lanes);

  float* const origin[3] = {rays.origin_x, rays.origin_y, rays.origin_z};
  float* const direction[3] = {rays.direction_x, rays.direction_y, rays.direction_z};
  const double radius = beams.table.origin_offset_m, ce = ray.cos_elevation, se = ray.sin_elevation;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < kLanes; ++i) {
      origin[k][i] = static_cast<float>(lanes.position[k][i] + radius * lanes.radial[k][i]);
      direction[k][i] = static_cast<float>(ce * lanes.radial[k][i] + se * lanes.up[k][i]);
    }
  }
  for (int i = 0; i < kLanes; ++i) {
    const bool off = i >= block.count || (closed >> i & 1) != 0;
    rays.near_m[i] = 0;
    rays.far_m[i] = off ? -1.0f : static_cast<float>(max_range_m);
  }
}

}  // namespace vsslam

#include "sensors/lidar/lidar_beams.h"

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

/// Direction of one laser's beam about the axis, for each lane: the azimuth of its cycle, turned on by what
/// the head turns until the laser fires (a small angle a; error a^5 / 120) and by the laser's own offset.
struct LaneDirections {
  alignas(64) double cosine[kLanes];
  alignas(64) double sine[kLanes];
  LaneDirections(const CycleAzimuths::Turning& turning, size_t first_cycle, double share_of_cycle,
                 const SubRay& ray) {
    const double* const c0 = &turning.cosine[first_cycle];
    const double* const s0 = &turning.sine[first_cycle];
    const double* const step = &turning.step_rad[first_cycle];
    const double co = ray.cos_offset, so = ray.sin_offset;
#pragma GCC ivdep
    for (int i = 0; i < kLanes; ++i) {
      const double a = step[i] * share_of_cycle, a2 = a * a;
      const double ca = 1 - a2 / 2 * (1 - a2 / 12), sa = a * (1 - a2 / 6);
      const double c = c0[i] * ca - s0[i] * sa, s = s0[i] * ca + c0[i] * sa;
      cosine[i] = c * co - s * so;
      sine[i] = s * co + c * so;
    }
  }
};

double share_of_cycle(const LaserTable& table, size_t laser) {
  return static_cast<double>(table.lasers[laser].fire_offset_ns) / static_cast<double>(table.cycle_ns);
}

}  // namespace

void make_rays(const Beams& beams, size_t laser, size_t sub_ray, const FiringBlock& block,
               const CycleAzimuths& azimuths, double max_range_m, uint32_t closed, RayPacket& rays) {
  const SubRay& ray = beams.ray(laser, sub_ray);
  const LaneDirections at(azimuths.actual, block.first, share_of_cycle(beams.table, laser), ray);
  const auto cycle_ns = static_cast<double>(beams.table.cycle_ns);
  const double first_s =
      (static_cast<double>(beams.table.lasers[laser].fire_offset_ns) - block.poses.mid_ns) /
      block.poses.half_ns;
  const double step_s = cycle_ns / block.poses.half_ns;

  float* const origin[3] = {rays.origin_x, rays.origin_y, rays.origin_z};
  float* const direction[3] = {rays.direction_x, rays.direction_y, rays.direction_z};
  const double radius = beams.table.origin_offset_m, ce = ray.cos_elevation, se = ray.sin_elevation;
  const auto& R = block.poses.R_world_lidar;
  const auto& p = block.poses.p_world_lidar;
  for (int k = 0; k < 3; ++k) {
    float* const o = origin[k];
    float* const d = direction[k];
    const double x0 = R[0](k, 0), x1 = R[1](k, 0), x2 = R[2](k, 0);
    const double y0 = R[0](k, 1), y1 = R[1](k, 1), y2 = R[2](k, 1);
    const double z0 = se * R[0](k, 2), z1 = se * R[1](k, 2), z2 = se * R[2](k, 2);
    const double p0 = p[0][k], p1 = p[1][k], p2 = p[2][k];
#pragma GCC ivdep
    for (int i = 0; i < kLanes; ++i) {
      const double s = first_s + i * step_s;
      const double radial = (x0 + s * (x1 + s * x2)) * at.cosine[i] + (y0 + s * (y1 + s * y2)) * at.sine[i];
      o[i] = static_cast<float>(p0 + s * (p1 + s * p2) + radius * radial);
      d[i] = static_cast<float>(ce * radial + (z0 + s * (z1 + s * z2)));
    }
  }
  for (int i = 0; i < kLanes; ++i) {
    const bool off = i >= block.count || (closed >> i & 1) != 0;
    rays.near_m[i] = 0;
    rays.far_m[i] = off ? -1.0f : static_cast<float>(max_range_m);
  }
}

void place_points(const Beams& beams, size_t laser, const FiringBlock& block, const CycleAzimuths& azimuths,
                  const float (&range_m)[kLanes], PointPacket& points) {
  const SubRay& ray = beams.ray(laser, 0);
  const LaneDirections at(azimuths.reported, block.first, share_of_cycle(beams.table, laser), ray);
  const double ce = ray.cos_elevation, se = ray.sin_elevation, dz = beams.table.lasers[laser].dz_m;
#pragma GCC ivdep
  for (int i = 0; i < kLanes; ++i) {
    const double range = range_m[i];
    points.x[i] = static_cast<float>(range * ce * at.cosine[i]);
    points.y[i] = static_cast<float>(range * ce * at.sine[i]);
    points.z[i] = static_cast<float>(range * se + dz);
  }
}

}  // namespace vsslam

#include "sensors/lidar/lidar_echo.h"

#include <algorithm>
#include <array>

namespace vsslam {

namespace {

constexpr float kRetroPowerGain = 100;
// Glass: what passes one pane both ways, how little of its albedo scatters back, and the mirror-like return
// when it is hit nearly head-on (within 1.1 deg).
constexpr float kGlassTransmission = 0.75f, kGlassScatter = 2e-4f;
constexpr float kGlassSpecularCos = 0.9998f, kGlassSpecularPower = 1;
constexpr int kGlassPanes = 3;
constexpr float kPaneGap_m = 1e-3f;

std::vector<Reflectance> reflectances(const World& world) {
  std::vector<Reflectance> all;
  for (const Material& material : world.materials) {
    Reflectance r;
    r.albedo = material.lidar_albedo;
    r.glass = material.glass;
    if (material.glass) r.albedo *= kGlassScatter;
    if (material.retro_reflective) r.reflectivity_low = 101, r.reflectivity_gain = 154;
    if (material.retro_reflective) r.power_gain = kRetroPowerGain;
    all.push_back(r);
  }
  if (all.empty()) all.emplace_back();  // lanes without a hit look at material 0
  return all;
}

/// What one sub-ray sends back from one surface.
struct Candidate {
  float range_m, energy, reflectivity, weight, cos_incidence;
  float x, y, z, normal_x, normal_y, normal_z;
  uint32_t object, triangle;
  int material, sub_ray;
};
struct LaneCandidates {
  std::array<Candidate, 37 * kGlassPanes> items;
  size_t size = 0;
};

/// Candidates within one pulse length of each other: the receiver sees one echo.
struct Echo {
  float received = 0, received_range = 0, energy = 0, reflectivity = 0;
  const Candidate* nearest_centre = nullptr;
  void add(const Candidate& c) {
    const float received_c = c.energy / (c.range_m * c.range_m);
    received += received_c;
    received_range += received_c * c.range_m;
    energy += c.energy;
    reflectivity += c.weight * c.reflectivity;
    if (!nearest_centre || c.sub_ray < nearest_centre->sub_ray) nearest_centre = &c;
  }
};

Echo choose(LaneCandidates& lane, float merge_m, bool last, float threshold) {
  const auto begin = lane.items.begin(), end = begin + static_cast<std::ptrdiff_t>(lane.size);
  std::sort(begin, end, [](const Candidate& a, const Candidate& b) {
    return a.range_m != b.range_m ? a.range_m < b.range_m : a.sub_ray < b.sub_ray;
  });
  Echo chosen, current;
  const auto close = [&] {
    const bool wins = current.received > chosen.received || (last && current.received >= threshold);
    if (current.nearest_centre && (wins || !chosen.nearest_centre)) chosen = current;
    current = Echo{};
  };
  for (auto it = begin; it != end; ++it) {
    if (it != begin && it->range_m - (it - 1)->range_m > merge_m) close();
    current.add(*it);
  }
  close();
  return chosen;
}

void report(const Echo& echo, int lane, EchoPacket& out) {
  static constexpr Candidate kNothing{};
  out.any[lane] = echo.nearest_centre ? 1 : 0;
  const Candidate& truth = echo.nearest_centre ? *echo.nearest_centre : kNothing;
  out.mean_range_m[lane] = echo.received > 0 ? echo.received_range / echo.received : truth.range_m;
  out.power[lane] = echo.energy;
  out.reflectivity[lane] = echo.reflectivity;
  out.range_m[lane] = truth.range_m;
  out.cos_incidence[lane] = truth.cos_incidence;
  out.x[lane] = truth.x, out.y[lane] = truth.y, out.z[lane] = truth.z;
  out.normal_x[lane] = truth.normal_x, out.normal_y[lane] = truth.normal_y,
  out.normal_z[lane] = truth.normal_z;
  out.object[lane] = truth.object, out.triangle[lane] = truth.triangle, out.material[lane] = truth.material;
}

float incidence_cosine(const RayPacket& rays, const HitPacket& hits, int i) {
  const float along = hits.normal_x[i] * rays.direction_x[i] + hits.normal_y[i] * rays.direction_y[i] +
                      hits.normal_z[i] * rays.direction_z[i];
  return std::min(1.0f, std::max(0.0f, -along));
}

Candidate candidate(const SubRay& ray, int sub_ray, const RayPacket& rays, const HitPacket& hits, int i,
                    const Reflectance& reflectance, float transmission) {
  Candidate c;
  const float cosine = incidence_cosine(rays, hits, i);
  const auto weight = static_cast<float>(ray.weight);
  float power = reflectance.albedo * cosine * reflectance.power_gain;
  if (reflectance.glass && cosine > kGlassSpecularCos) power = kGlassSpecularPower;
  c.range_m = hits.range_m[i] + static_cast<float>(ray.range_offset_m);
  c.energy = weight * transmission * power;
  c.reflectivity = reflectance.reflectivity_low + reflectance.reflectivity_gain * reflectance.albedo * cosine;
  c.weight = weight * transmission;
  c.cos_incidence = cosine;
  c.x = rays.origin_x[i] + hits.range_m[i] * rays.direction_x[i];
  c.y = rays.origin_y[i] + hits.range_m[i] * rays.direction_y[i];
  c.z = rays.origin_z[i] + hits.range_m[i] * rays.direction_z[i];
  c.normal_x = hits.normal_x[i], c.normal_y = hits.normal_y[i], c.normal_z = hits.normal_z[i];
  c.object = hits.object[i], c.triangle = hits.triangle[i], c.material = hits.material[i];
  c.sub_ray = sub_ray;
  return c;
}

}  // namespace

EchoReceiver::EchoReceiver(const LidarConfig& config, const World& world)
    : config_(config),
      reflectance_(reflectances(world)),
      world_has_glass_(
          std::any_of(reflectance_.begin(), reflectance_.end(), [](const auto& r) { return r.glass; })),
      merge_m_(static_cast<float>(0.5 * 0.299792458 * config.pulse_length_ns)) {}

bool EchoReceiver::any_glass(const HitPacket& hits) const {
  if (!world_has_glass_) return false;
  for (int i = 0; i < kLanes; ++i)
    if (hits.object[i] != HitPacket::kNoHit && reflectance_[static_cast<size_t>(hits.material[i])].glass)
      return true;
  return false;
}

void EchoReceiver::receive(const Raycaster& raycaster, const Beams& beams, const FiringBlock& block,
                           const CycleAzimuths& azimuths, uint32_t closed,
                           std::span<EchoPacket> echoes) const {
  std::array<RayPacket, kMaxLasers> rays;
  std::array<HitPacket, kMaxLasers> hits;
  const bool footprint = beams.sub_rays > 1;
  for (size_t laser = 0; laser < beams.lasers && !footprint; ++laser)
    make_rays(beams, laser, 0, block, azimuths, config_.max_range_m, closed, rays[laser]);
  if (!footprint) raycaster.trace({rays.data(), beams.lasers}, {hits.data(), beams.lasers});
  for (size_t laser = 0; laser < beams.lasers; ++laser) {
    if (footprint || any_glass(hits[laser]))
      receive_footprint(raycaster, beams, laser, block, azimuths, closed, echoes[laser]);
    else
      single(beams.ray(laser, 0), rays[laser], hits[laser], echoes[laser]);
  }
}

// One ray, one surface: nothing to weigh or choose.
void EchoReceiver::single(const SubRay& ray, const RayPacket& rays, const HitPacket& hits,
                          EchoPacket& echo) const {
  const auto range_offset = static_cast<float>(ray.range_offset_m);
#pragma GCC ivdep
  for (int i = 0; i < kLanes; ++i) {
    const bool hit = hits.object[i] != HitPacket::kNoHit;
    const float range = hit ? hits.range_m[i] : 0.0f;
    const float nx = hit ? hits.normal_x[i] : 0.0f, ny = hit ? hits.normal_y[i] : 0.0f,
                nz = hit ? hits.normal_z[i] : 0.0f;
    const float along = nx * rays.direction_x[i] + ny * rays.direction_y[i] + nz * rays.direction_z[i];
    const float cosine = along < 0.0f ? -along : 0.0f;
    echo.any[i] = hit ? 1 : 0;
    echo.cos_incidence[i] = cosine < 1.0f ? cosine : 1.0f;
    echo.range_m[i] = echo.mean_range_m[i] = range + range_offset;
    echo.x[i] = rays.origin_x[i] + range * rays.direction_x[i];
    echo.y[i] = rays.origin_y[i] + range * rays.direction_y[i];
    echo.z[i] = rays.origin_z[i] + range * rays.direction_z[i];
    echo.normal_x[i] = nx;
    echo.normal_y[i] = ny;
    echo.normal_z[i] = nz;
    echo.object[i] = hits.object[i];
    echo.triangle[i] = hits.triangle[i];
    echo.material[i] = hits.material[i];
  }
  for (int i = 0; i < kLanes; ++i) {
    const Reflectance& reflectance = reflectance_[static_cast<size_t>(hits.material[i])];
    const float returned = reflectance.albedo * echo.cos_incidence[i];
    echo.power[i] = returned * reflectance.power_gain;
    echo.reflectivity[i] = reflectance.reflectivity_low + reflectance.reflectivity_gain * returned;
  }
}

void EchoReceiver::receive_footprint(const Raycaster& raycaster, const Beams& beams, size_t laser,
                                     const FiringBlock& block, const CycleAzimuths& azimuths, uint32_t closed,
                                     EchoPacket& echo) const {
  std::array<LaneCandidates, kLanes> lanes;
  for (size_t sub_ray = 0; sub_ray < beams.sub_rays; ++sub_ray) {
    const SubRay& ray = beams.ray(laser, sub_ray);
    RayPacket rays;
    HitPacket hits;
    make_rays(beams, laser, sub_ray, block, azimuths, config_.max_range_m, closed, rays);
    float transmission = 1;
    for (int pane = 0; pane < kGlassPanes; ++pane, transmission *= kGlassTransmission) {
      raycaster.trace({&rays, 1}, {&hits, 1});
      bool again = false;
      for (int i = 0; i < kLanes; ++i) {
        const bool hit = hits.object[i] != HitPacket::kNoHit;
        if (!hit) rays.far_m[i] = -1;
        if (!hit) continue;
        const Reflectance& reflectance = reflectance_[static_cast<size_t>(hits.material[i])];
        LaneCandidates& lane = lanes[static_cast<size_t>(i)];
        lane.items[lane.size++] =
            candidate(ray, static_cast<int>(sub_ray), rays, hits, i, reflectance, transmission);
        rays.near_m[i] = hits.range_m[i] + kPaneGap_m;
        if (!reflectance.glass) rays.far_m[i] = -1;
        again |= reflectance.glass;
      }
      if (!again) break;
    }
  }
  const bool last = config_.return_mode == LidarConfig::ReturnMode::last;
  const auto threshold = static_cast<float>(0.1 / (config_.detection_range_m * config_.detection_range_m));
  for (int i = 0; i < kLanes; ++i)
    report(choose(lanes[static_cast<size_t>(i)], merge_m_, last, threshold), i, echo);
}

}  // namespace vsslam

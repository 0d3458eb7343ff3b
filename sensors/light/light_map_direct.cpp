#include "sensors/light/light_map_direct.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rng.h"

namespace vsslam {

namespace {

constexpr float kFaint = 1.0f / 500;       // of all light of its group: a source below is left out ...
constexpr float kFaintOfMany = 1.0f / 40;  // ... or below this where the group has more than kMany of them
constexpr size_t kMany = 128;
constexpr float kSunlight_m = 1e4f;       // how far off what shades the sun may be
constexpr float kAroundSource_m = 0.02f;  // what is nearer to a source than this does not shade it
constexpr int kMostShadowRays = 12;

/// Collects shadow rays until a packet is full, then credits those that arrive.
class ShadowRays {
 public:
  ShadowRays(const Raycaster& raycaster, std::vector<float>& illuminance)
      : raycaster_(raycaster), illuminance_(illuminance) {}
  ~ShadowRays() = default;
  ShadowRays(const ShadowRays&) = delete;
  ShadowRays& operator=(const ShadowRays&) = delete;

  void add(const Vec3f& from, const Vec3f& direction, float far_m, size_t slot, float lux) {
    rays_.origin_x[count_] = from.x(), rays_.origin_y[count_] = from.y(), rays_.origin_z[count_] = from.z();
    rays_.direction_x[count_] = direction.x(), rays_.direction_y[count_] = direction.y();
    rays_.direction_z[count_] = direction.z();
    rays_.near_m[count_] = 0;
    rays_.far_m[count_] = far_m;
    slot_[count_] = slot;
    lux_[count_] = lux;
    if (++count_ == RayPacket::kRays) flush();
  }
  void flush() {
    for (int i = count_; i < RayPacket::kRays; ++i) rays_.near_m[i] = 1, rays_.far_m[i] = 0;
    const uint32_t blocked = raycaster_.occluded(rays_);
    for (int i = 0; i < count_; ++i)
      if (!(blocked >> i & 1)) illuminance_[slot_[i]] += lux_[i];
    count_ = 0;
  }

 private:
  const Raycaster& raycaster_;
  std::vector<float>& illuminance_;
  RayPacket rays_{};
  size_t slot_[RayPacket::kRays] = {};
  float lux_[RayPacket::kRays] = {};
  int count_ = 0;
};

/// Points spread over the source's disc; the pattern turns from site to site.
class DiscPattern {
 public:
  DiscPattern(const LightSource& source, int points, uint64_t bits)
      : source_(source),
        points_(static_cast<float>(points)),
        phase_(static_cast<float>(bits >> 40) * 0x1p-24f),
        inset_(static_cast<float>(bits & 0xFFFFFF) * 0x1p-24f) {
    const Vec3f& n = source.direction_world;
    right_ = (std::abs(n.z()) < 0.9f ? Vec3f::UnitZ().cross(n) : Vec3f::UnitX().cross(n)).normalized();
    up_ = n.cross(right_);
  }
  Vec3f operator()(int k) const {
    constexpr float kGoldenTurn = 0.381966f;
    const float r = source_.radius_m * std::sqrt((static_cast<float>(k) + inset_) / points_);
    const float angle = 2 * std::numbers::pi_v<float> * (phase_ + kGoldenTurn * static_cast<float>(k));
    return source_.position_world + r * (std::cos(angle) * right_ + std::sin(angle) * up_);
  }

 private:
  const LightSource& source_;
  float points_, phase_, inset_;
  Vec3f right_, up_;
};

int shadow_rays(const LightSource& source, const Vec3f& at) {
  if (source.kind == LightSource::Kind::directional || source.radius_m <= 0) return 1;
  const float angle = source.radius_m / std::max(1e-3f, (source.position_world - at).norm());
  return std::clamp(static_cast<int>(std::ceil(30 * angle)), 1, kMostShadowRays);
}

}  // namespace

void add_direct_light(const LitScene& scene, size_t begin, size_t end, std::vector<float>& illuminance) {
  const LightSources& lights = scene.lights;
  const RandomStream stream(1, "shadow rays");
  const size_t groups = lights.groups.size();
  ShadowRays rays(scene.raycaster, illuminance);
  std::vector<float> lux(lights.sources.size()), of_group(groups), faint(groups);
  for (size_t g = 0; g < groups; ++g) {
    const auto members =
        std::count_if(lights.sources.begin(), lights.sources.end(),
                      [g](const LightSource& s) { return static_cast<size_t>(s.group) == g; });
    faint[g] = static_cast<size_t>(members) > kMany ? kFaintOfMany : kFaint;
  }
  for (size_t i = begin; i < end; ++i) {
    const LightMapCharts::Site& site = scene.charts.sites[i];
    const Vec3f& normal = scene.triangles.all[site.triangle].normal_world;
    std::fill(of_group.begin(), of_group.end(), 0.0f);
    for (size_t k = 0; k < lux.size(); ++k) {
      lux[k] = lights.sources[k].illuminance(site.position_world, normal);
      of_group[static_cast<size_t>(lights.sources[k].group)] += lux[k];
    }
    for (size_t k = 0; k < lux.size(); ++k) {
      const LightSource& source = lights.sources[k];
      const auto group = static_cast<size_t>(source.group);
      if (!(lux[k] > faint[group] * of_group[group])) continue;
      const size_t slot = i * groups + group;
      if (source.kind == LightSource::Kind::directional) {
        rays.add(site.position_world, -source.direction_world, kSunlight_m, slot, lux[k]);
        continue;
      }
      const int count = shadow_rays(source, site.position_world);
      const DiscPattern points(source, count, stream.bits(i, k));
      for (int p = 0; p < count; ++p) {
        const Vec3f to = points(p) - site.position_world;
        const float distance = std::max(to.norm(), 1e-6f);
        rays.add(site.position_world, to / distance, std::max(0.0f, distance - kAroundSource_m), slot,
                 lux[k] / static_cast<float>(count));
      }
    }
  }
  rays.flush();
}

}  // namespace vsslam

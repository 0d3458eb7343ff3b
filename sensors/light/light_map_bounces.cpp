#include "sensors/light/light_map_bounces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ordered_parallel.h"
#include "core/rng.h"

namespace vsslam {

namespace {

constexpr uint32_t kNowhere = 0xFFFFFFFFu;
constexpr size_t kRayBudget = 7'000'000;
constexpr size_t kMostRays = 64, kFewestRays = 16;  // of a site, in packets of 16
constexpr int kMostBounces = 24;
constexpr float kSettled = 0.002f;    // relative change at which bounces end
constexpr float kAmbientReach_m = 4;  // without any light, what is farther off than this does not shade
constexpr size_t kSitesPerPiece = 256;

/// Directions over the hemisphere of a normal by the cosine law, stratified in `rays` cells.
class CosineDirections {
 public:
  CosineDirections(const Vec3f& normal, size_t rays) : normal_(normal), across_(1) {
    while (across_ * across_ * 2 <= rays) across_ *= 2;
    around_ = rays / across_;
    right_ = (std::abs(normal.z()) < 0.9f ? Vec3f::UnitZ().cross(normal) : Vec3f::UnitX().cross(normal))
                 .normalized();
    up_ = normal.cross(right_);
  }
  Vec3f operator()(size_t k, uint64_t bits) const {
    const float a = static_cast<float>(bits >> 40) * 0x1p-24f,
                b = static_cast<float>(bits & 0xFFFFFF) * 0x1p-24f;
    const float r2 = (static_cast<float>(k % across_) + a) / static_cast<float>(across_);
    const float angle =
        2 * std::numbers::pi_v<float> * (static_cast<float>(k / across_) + b) / static_cast<float>(around_);
    const float r = std::sqrt(r2), z = std::sqrt(std::max(0.0f, 1 - r2));
    return r * std::cos(angle) * right_ + r * std::sin(angle) * up_ + z * normal_;
  }

 private:
  Vec3f normal_, right_, up_;
  size_t across_, around_ = 1;
};

class Bounces {
 public:
  Bounces(const LitScene& scene, const std::vector<float>& direct)
      : scene_(scene),
        direct_(direct),
        sites_(scene.charts.sites.size()),
        groups_(scene.lights.groups.size()),
        rays_(std::clamp(kRayBudget / std::max<size_t>(1, sites_) / 16 * 16, kFewestRays, kMostRays)),
        hits_(sites_ * rays_, kNowhere),
        from_sky_(scene.lights.daylight_group >= 0 ? sites_ : 0),
        backs_(sites_) {}

  IndirectLight run() {
    in_pieces([this](size_t i) { trace(i); });
    reflect_and_emit();
    IndirectLight light{std::vector<float>(sites_ * groups_), rays_, std::vector<bool>(sites_)};
    for (int bounce = 0; bounce < kMostBounces; ++bounce)
      if (gather(light.illuminance) < kSettled) break;
    for (size_t i = 0; i < sites_; ++i) light.buried[i] = 2 * backs_[i] > rays_;
    return light;
  }

 private:
  template <class Body>
  void in_pieces(const Body& body) {
    parallel_pieces(sites_, kSitesPerPiece, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) body(i);
    });
  }

  void trace(size_t i) {
    const LightMapCharts::Site& site = scene_.charts.sites[i];
    const CosineDirections directions(scene_.triangles.all[site.triangle].normal_world, rays_);
    const RandomStream stream(1, "bounces");
    RayPacket rays;
    SurfacePacket surfaces;
    std::fill(std::begin(rays.near_m), std::end(rays.near_m), 0.0f);
    std::fill(std::begin(rays.far_m), std::end(rays.far_m), scene_.lights.ambient ? kAmbientReach_m : 1e4f);
    for (size_t first = 0; first < rays_; first += RayPacket::kRays) {
      for (size_t k = 0; k < RayPacket::kRays; ++k) {
        const Vec3f d = directions(first + k, stream.bits(i, first + k));
        rays.origin_x[k] = site.position_world.x(), rays.origin_y[k] = site.position_world.y();
        rays.origin_z[k] = site.position_world.z();
        rays.direction_x[k] = d.x(), rays.direction_y[k] = d.y(), rays.direction_z[k] = d.z();
      }
      scene_.raycaster.trace({&rays, 1}, {&surfaces, 1}, false);
      for (size_t k = 0; k < RayPacket::kRays; ++k) keep(i, first + k, rays, surfaces, k);
    }
  }

  void keep(size_t i, size_t ray, const RayPacket& rays, const SurfacePacket& surfaces, size_t k) {
    const Vec3f direction(rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]);
    if (surfaces.object[k] == HitPacket::kNoHit) {
      if (from_sky_.empty()) return;
      const float z = scene_.lights.ambient ? std::abs(direction.z()) : direction.z();
      from_sky_[i] += scene_.lights.sky.dome(z) * std::numbers::pi_v<float> / static_cast<float>(rays_);
      return;
    }
    const size_t triangle = scene_.triangles.index(surfaces.object[k], surfaces.triangle[k]);
    if (scene_.triangles.all[triangle].normal_world.dot(direction) > 0) {
      ++backs_[i];
      return;
    }
    const LightMapCharts::Place& place = scene_.charts.of_triangle[triangle];
    const float u = surfaces.u[k], v = surfaces.v[k];
    const Vec2f at = (1 - u - v) * place.corners[0] + u * place.corners[1] + v * place.corners[2];
    hits_[i * rays_ + ray] = place.offset + static_cast<uint32_t>(at.y() + 0.5f) * place.stride +
                             static_cast<uint32_t>(at.x() + 0.5f);
  }

  void reflect_and_emit() {
    std::vector<float> emitted(scene_.triangles.all.size());
    std::vector<int> group_of_triangle(emitted.size());
    for (const Glow& glow : scene_.lights.glows)
      if (glow.gathered)
        emitted[glow.triangle] = glow.luminance, group_of_triangle[glow.triangle] = glow.group;
    reflectance_.resize(sites_);
    emitted_.assign(sites_ * groups_, 0.0f);
    radiance_.assign(scene_.charts.nodes * groups_, 0.0f);
    in_pieces([&](size_t i) {
      const LightMapCharts::Site& site = scene_.charts.sites[i];
      const PlacedTriangle& t = scene_.triangles.all[site.triangle];
      const Pyramid& pyramid = scene_.textures.of_material(t.material);
      const Vec2f e1 = t.uv[1] - t.uv[0], e2 = t.uv[2] - t.uv[0];
      const float texels = 0.5f * std::abs(e1.x() * e2.y() - e1.y() * e2.x()) *
                           static_cast<float>(pyramid.width_px) * static_cast<float>(pyramid.height_px);
      const float texels_per_m = std::sqrt(texels / std::max(t.area_m2, 1e-12f));
      reflectance_[i] = scene_.textures.sample(pyramid, t.uv[0] + site.u * e1 + site.v * e2,
                                               texels_per_m * static_cast<float>(scene_.charts.spacing_m));
      if (emitted[site.triangle] > 0)
        emitted_[i * groups_ + static_cast<size_t>(group_of_triangle[site.triangle])] =
            emitted[site.triangle];
    });
  }

  /// One more bounce; returns the largest relative change.
  float gather(std::vector<float>& indirect) {
    in_pieces([&](size_t i) {
      for (size_t g = 0; g < groups_; ++g) {
        const size_t k = i * groups_ + g;
        radiance_[scene_.charts.sites[i].node * groups_ + g] =
            emitted_[k] + reflectance_[i] / std::numbers::pi_v<float> * (direct_[k] + indirect[k]);
      }
    });
    std::vector<float> change((sites_ + kSitesPerPiece - 1) / kSitesPerPiece);
    in_pieces([&](size_t i) {
      for (size_t g = 0; g < groups_; ++g) {
        float sum = 0;
        for (size_t r = 0; r < rays_; ++r) {
          const uint32_t node = hits_[i * rays_ + r];
          if (node != kNowhere) sum += radiance_[node * groups_ + g];
        }
        float lux = sum * std::numbers::pi_v<float> / static_cast<float>(rays_);
        if (!from_sky_.empty() && static_cast<int>(g) == scene_.lights.daylight_group) lux += from_sky_[i];
        float& slot = indirect[i * groups_ + g];
        float& most = change[i / kSitesPerPiece];
        if (lux > 0) most = std::max(most, (lux - slot) / lux);
        slot = lux;
      }
    });
    return change.empty() ? 0.0f : *std::max_element(change.begin(), change.end());
  }

  const LitScene& scene_;
  const std::vector<float>& direct_;
  size_t sites_, groups_, rays_;
  std::vector<uint32_t> hits_;  ///< sites x rays: the node that was hit
  std::vector<float> from_sky_;
  std::vector<uint8_t> backs_;
  std::vector<float> reflectance_, emitted_, radiance_;
};

}  // namespace

IndirectLight bounce_light(const LitScene& scene, const std::vector<float>& direct) {
  return Bounces(scene, direct).run();
}

}  // namespace vsslam

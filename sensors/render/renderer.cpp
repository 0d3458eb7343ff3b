#include "sensors/render/renderer.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>

#include "core/ordered_parallel.h"
#include "sensors/light/light_map.h"
#include "sensors/render/beam.h"
#include "sensors/render/facets.h"
#include "sensors/render/shading.h"
#include "sensors/surface/lanes.h"

namespace vsslam {

namespace {

constexpr double kNodeSpacing_m = 0.15;
constexpr size_t kMostNodes = 600'000;
constexpr float kNearest_m = 0.02f, kFarthest_m = 1e5f;

/// Rays of a beam, to be traced one by one.
constexpr int kPackets = Beam::kRays / RayPacket::kRays;

void unpack(const Beam& beam, RayPacket (&packets)[kPackets]) {
  using namespace lanes;
  for (int i = 0; i < Beam::kRays; i += kLanes) {
    RayPacket& packet = packets[i / RayPacket::kRays];
    const int first = i % RayPacket::kRays;
    store(packet.direction_x + first, load(beam.x + i));
    store(packet.direction_y + first, load(beam.y + i));
    store(packet.direction_z + first, load(beam.z + i));
    store(packet.origin_x + first, all(beam.origin.x()));
    store(packet.origin_y + first, all(beam.origin.y()));
    store(packet.origin_z + first, all(beam.origin.z()));
    store(packet.near_m + first, all(kNearest_m));
    store(packet.far_m + first, all(kFarthest_m));
  }
}

/// The part of the tile that lies in the image. Its pixels come in rows of 4.
void copy(const ShadedTile& tile, int left, int top, const ViewRays& rays, View& view) {
  constexpr int kRow = RayTile::kBlockWidth_px;
  for (int i = 0; i < RayTile::kRays; i += kRow) {
    const int x = left + RayTile::pixel_x(i), y = top + RayTile::pixel_y(i);
    if (x >= rays.width_px || y >= rays.height_px) continue;
    const auto pixel = static_cast<size_t>(y) * static_cast<size_t>(rays.width_px) + static_cast<size_t>(x);
    std::copy_n(&tile.luminance[i], kRow, &view.luminance[pixel]);
    std::copy_n(&tile.depth_m[i], kRow, &view.depth_m[pixel]);
  }
}

// Assigning {} or clearing would keep the memory.
template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace

struct Renderer::Impl {
  Impl(const World& world, const Raycaster& caster, const LightingConfig& lighting)
      : raycaster(caster),
        illumination(illuminate(world, lighting)),
        triangles(world),
        textures(world),
        lights(world, triangles, illumination) {
    // The large tables last, so that they do not meet in memory what is needed for a while only.
    LightMapCharts charts = chart_surfaces(triangles, kNodeSpacing_m, kMostNodes);
    light_map = bake_light_map({triangles, charts, textures, lights, raycaster});
    release(charts.sites);
    malloc_trim(0);  // a million small pieces of charts, freed, would stay with the process
    tree = TriangleTree(triangles);
    records = surface_records(triangles, charts, textures);
    release(charts.of_triangle);
    tree.rename(facets(triangles, records));
    // Interpolation reads the row below the last one, with weight 0.
    for (const LightMapCharts::Grid& grid : charts.grids) padding = std::max(padding, size_t{grid.width} + 2);
    first_of_object = triangles.first_of_object;
    release(triangles.all);
    set_levels(std::vector<float>(lights.groups.size(), 1.0f));
  }

  void set_levels(std::vector<float> of_group) {
    levels = std::move(of_group);
    levels.resize(lights.groups.size(), 1.0f);
    illuminance = light_map.combined(levels);
    illuminance.resize(illuminance.size() + padding, 0.0f);
    for (const Glow& glow : lights.glows)
      records[glow.triangle].luminance = glow.luminance * levels[static_cast<size_t>(glow.group)];
  }

  float level(int group) const { return group < 0 ? 0.0f : levels[static_cast<size_t>(group)]; }

  Sky sky() const {
    Sky now = lights.sky;
    now.zenith *= level(lights.daylight_group);
    now.sun_lux *= level(lights.sun_group);
    return now;
  }

  Surfaces surfaces() const {
    const Headlight& h = illumination.headlight;
    return {.textures = textures,
            .records = records,
            .first_of_object = first_of_object,
            .illuminance = illuminance,
            .headlight_cd = level(lights.headlight_group) * static_cast<float>(h.intensity_cd),
            .headlight_cos_inner = static_cast<float>(std::cos(0.75 * h.cone_rad)),
            .headlight_cos_outer = static_cast<float>(std::cos(h.cone_rad)),
            .sky = sky()};
  }

  std::vector<MovedTriangles> moved() const {
    std::vector<MovedTriangles> all;
    for (const Raycaster::Moved& m : raycaster.moved())
      all.push_back({.first = static_cast<uint32_t>(first_of_object[m.object]),
                     .end = static_cast<uint32_t>(first_of_object[m.object + 1]),
                     .present = m.present,
                     .low_world = m.low_world,
                     .high_world = m.high_world});
    return all;
  }

  void trace_singly(const Surfaces& surfaces, const Viewpoint& viewpoint, const Beam& beam,
                    ShadedTile& shaded) const {
    RayPacket packets[kPackets];
    SurfacePacket hits[kPackets];
    unpack(beam, packets);
    raycaster.trace(packets, hits);
    for (int k = 0; k < kPackets; ++k)
      shade(surfaces, viewpoint, packets[k], hits[k], k * RayPacket::kRays, shaded);
  }

  const Raycaster& raycaster;
  Illumination illumination;
  PlacedTriangles triangles;
  GreyTextures textures;
  LightSources lights;
  TriangleTree tree;
  std::vector<size_t> first_of_object;
  std::vector<SurfaceRecord> records;
  LightMap light_map;
  size_t padding = 2;
  std::vector<float> levels;       ///< of each group
  std::vector<float> illuminance;  ///< of the light map's nodes at these levels
};

Renderer::Renderer(const World& world, const Raycaster& raycaster, const LightingConfig& lighting)
    : impl_(std::make_unique<Impl>(world, raycaster, lighting)) {}

Renderer::~Renderer() = default;

const std::vector<std::string>& Renderer::light_groups() const {
  return impl_->lights.groups;
}

void Renderer::set_light_levels(const LightLevels& levels) {
  impl_->set_levels(levels.of_group);
}

void Renderer::render(const SE3& T_world_camera, const ViewRays& rays, View& view) const {
  view.luminance.resize(rays.direction_camera.size());
  view.depth_m.resize(rays.direction_camera.size());
  const Eigen::Matrix3f R = T_world_camera.matrix3().cast<float>();
  const Vec3f origin = T_world_camera.translation.cast<float>();
  const Viewpoint viewpoint{R.col(0), R.col(1), R.col(2), rays.pixel_angle_rad};
  const Surfaces surfaces = impl_->surfaces();
  const std::vector<MovedTriangles> moved = impl_->moved();
  const auto columns = static_cast<size_t>(rays.tile_columns);
  parallel_pieces(rays.tiles.size(), 4 * columns, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const RayTile& tile = rays.tiles[i];
      const Beam beam = beam_of(tile, origin, R);
      BeamHits hits;
      ShadedTile shaded;
      if (tile.narrow && trace(impl_->tree, beam, moved, kNearest_m, hits))
        shade(surfaces, viewpoint, tile, beam, hits, shaded);
      else
        impl_->trace_singly(surfaces, viewpoint, beam, shaded);
      copy(shaded, static_cast<int>(i % columns) * RayTile::kSide_px,
           static_cast<int>(i / columns) * RayTile::kSide_px, rays, view);
    }
  });
}

}  // namespace vsslam

#include "sensors/renderer.h"

#include <algorithm>
#include <cmath>

#include "core/ordered_parallel.h"
#include "sensors/light_map.h"
#include "sensors/shading.h"

namespace vsslam {

namespace {

constexpr double kNodeSpacing_m = 0.15;
constexpr size_t kMostNodes = 600'000;
constexpr int kTile_px = 4;
constexpr size_t kTilesAtOnce = 16;  // traced together, so that neither rays nor hits leave the first cache
constexpr float kNearest_m = 0.02f, kFarthest_m = 1e5f;

/// The rays of a 4 x 4 tile.
void aim(const Vec3f& origin, const Eigen::Matrix3f& R_world_camera, const ViewRays& rays, int x, int y,
         RayPacket& packet) {
  for (int i = 0; i < RayPacket::kRays; ++i) {
    const size_t pixel = static_cast<size_t>(y + i / kTile_px) * static_cast<size_t>(rays.width_px) +
                         static_cast<size_t>(x + i % kTile_px);
    const Vec3f& d = rays.direction_camera[pixel];
    packet.direction_x[i] = d.x(), packet.direction_y[i] = d.y(), packet.direction_z[i] = d.z();
  }
  using namespace lanes;
  const Eigen::Matrix3f& R = R_world_camera;
  for (int first : {0, kLanes}) {
    const Floats dx = load(packet.direction_x + first), dy = load(packet.direction_y + first),
                 dz = load(packet.direction_z + first);
    store(packet.direction_x + first, R(0, 0) * dx + R(0, 1) * dy + R(0, 2) * dz);
    store(packet.direction_y + first, R(1, 0) * dx + R(1, 1) * dy + R(1, 2) * dz);
    store(packet.direction_z + first, R(2, 0) * dx + R(2, 1) * dy + R(2, 2) * dz);
    store(packet.origin_x + first, all(origin.x()));
    store(packet.origin_y + first, all(origin.y()));
    store(packet.origin_z + first, all(origin.z()));
    store(packet.near_m + first, all(kNearest_m));
    store(packet.far_m + first, all(kFarthest_m));
  }
}

}  // namespace

struct Renderer::Impl {
  Impl(const World& world, const Raycaster& caster, const LightingConfig& lighting)
      : raycaster(caster),
        illumination(illuminate(world, lighting)),
        triangles(world),
        textures(world),
        lights(world, triangles, illumination) {
    const LightMapCharts charts = chart_surfaces(triangles, kNodeSpacing_m, kMostNodes);
    records = surface_records(triangles, charts, textures);
    light_map = bake_light_map({triangles, charts, textures, lights, raycaster});
    // Interpolation reads the row below the last one, with weight 0.
    for (const LightMapCharts::Grid& grid : charts.grids) padding = std::max(padding, size_t{grid.width} + 2);
    first_of_object = triangles.first_of_object;
    triangles.all = {};
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

  const Raycaster& raycaster;
  Illumination illumination;
  PlacedTriangles triangles;
  GreyTextures textures;
  LightSources lights;
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
  const auto width = static_cast<size_t>(rays.width_px), height = static_cast<size_t>(rays.height_px);
  view.luminance.resize(width * height);
  view.depth_m.resize(width * height);
  const Eigen::Matrix3f R = T_world_camera.matrix3().cast<float>();
  const Vec3f origin = T_world_camera.translation.cast<float>();
  const Viewpoint viewpoint{R.col(0), R.col(1), R.col(2), rays.pixel_angle_rad};
  const Surfaces surfaces = impl_->surfaces();
  const size_t columns = width / kTile_px, tile_rows = height / kTile_px;

  const auto render_tiles = [&](size_t row, size_t begin, size_t end) {
    RayPacket packets[kTilesAtOnce];
    SurfacePacket hits[kTilesAtOnce];
    const size_t count = end - begin;
    for (size_t i = 0; i < count; ++i)
      aim(origin, R, rays, static_cast<int>((begin + i) * kTile_px), static_cast<int>(row * kTile_px),
          packets[i]);
    impl_->raycaster.trace(std::span(packets, count), std::span(hits, count));
    for (size_t i = 0; i < count; ++i) {
      ShadedPacket shaded;
      shade(surfaces, viewpoint, packets[i], hits[i], shaded);
      for (size_t line = 0; line < kTile_px; ++line) {
        const size_t pixel = (row * kTile_px + line) * width + (begin + i) * kTile_px;
        std::copy_n(&shaded.luminance[line * kTile_px], kTile_px, &view.luminance[pixel]);
        std::copy_n(&shaded.depth_m[line * kTile_px], kTile_px, &view.depth_m[pixel]);
      }
    }
  };
  parallel_pieces(tile_rows, 8, [&](size_t first, size_t last) {
    for (size_t row = first; row < last; ++row)
      for (size_t begin = 0; begin < columns; begin += kTilesAtOnce)
        render_tiles(row, begin, std::min(columns, begin + kTilesAtOnce));
  });
}

}  // namespace vsslam

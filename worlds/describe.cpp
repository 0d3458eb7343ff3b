#include "worlds/describe.h"

#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <map>

#include "worlds/route.h"

namespace vsslam {

namespace {

std::string describe_materials(const World& world) {
  std::vector<size_t> triangles(world.materials.size(), 0);
  for (const Object& object : world.objects)
    for (const Primitive& p : world.meshes[static_cast<size_t>(object.mesh)].primitives)
      triangles[static_cast<size_t>(p.material)] += p.triangles.size();
  std::string text = fmt::format("materials: {:>31} {:>12}  lidar\n", "triangles", "texture");
  for (size_t i = 0; i < world.materials.size(); ++i) {
    const Material& m = world.materials[i];
    std::string texture = "-";
    if (m.base_color_texture >= 0) {
      const Texture& t = world.textures[static_cast<size_t>(m.base_color_texture)];
      texture = fmt::format("{} x {}", t.width_px, t.height_px);
    }
    fmt::format_to(std::back_inserter(text), "  {:<30} {:>9} {:>12}  albedo {:.2f}{}{}\n", m.name,
                   triangles[i], texture, m.lidar_albedo, m.retro_reflective ? ", retro-reflective" : "",
                   m.glass ? ", glass" : "");
  }
  return text;
}

std::string describe_lights(const World& world) {
  std::map<std::string, size_t> groups;
  for (const Light& light : world.lights) ++groups[light.group];
  std::string text = fmt::format("lights: {}\n", world.lights.size());
  for (const auto& [group, count] : groups)
    fmt::format_to(std::back_inserter(text), "  {:<30} {:>9}\n", group.empty() ? "(no group)" : group, count);
  return text;
}

}  // namespace

Bounds bounds(const World& world) {
  constexpr double kFar = std::numeric_limits<double>::max();
  Bounds b{Vec3::Constant(kFar), Vec3::Constant(-kFar)};
  for (const Object& object : world.objects)
    for (const Primitive& primitive : world.meshes[static_cast<size_t>(object.mesh)].primitives)
      for (const Vec3f& p : primitive.positions) {
        const Vec3 p_world = object.T_world_object * p.cast<double>();
        b.low_world = b.low_world.cwiseMin(p_world);
        b.high_world = b.high_world.cwiseMax(p_world);
      }
  return b.low_world.x() > b.high_world.x() ? Bounds{} : b;
}

std::string describe(const World& world) {
  const Bounds b = bounds(world);
  const Vec3 size = b.high_world - b.low_world;
  std::string text = fmt::format("world {}\n", world.name);
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out, "size: {:.2f} x {:.2f} x {:.2f} m, from ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f})\n",
      size.x(), size.y(), size.z(), b.low_world.x(), b.low_world.y(), b.low_world.z(), b.high_world.x(),
      b.high_world.y(), b.high_world.z());
  fmt::format_to(out, "triangles: {}   objects: {}   meshes: {}   textures: {}\n", world.triangle_count(),
                 world.objects.size(), world.meshes.size(), world.textures.size());
  const Floor& f = world.floor;
  fmt::format_to(out, "floor: at {:.3f} m{}\n", f.height_m,
                 f.unevenness_m == 0
                     ? ", even"
                     : fmt::format(", {:.4f} m RMS, waves from {:.2f} m", f.unevenness_m, f.wavelength_m));
  text += describe_materials(world);
  fmt::format_to(out, "routes: {}\n", world.routes.size());
  for (const Route& route : world.routes)
    fmt::format_to(out, "  {:<30} {:>9.2f} m, {} points, {}\n", route.name, route_length_m(route),
                   route.points_world.size(), route.closed ? "closed" : "open");
  return text + describe_lights(world);
}

}  // namespace vsslam

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/files.h"
#include "worlds/gltf/container.h"
#include "worlds/gltf/gltf.h"
#include "worlds/gltf/parts.h"
#include "worlds/gltf/schema.h"

namespace vsslam {

namespace {

using nlohmann::json;

// Extensions that a file may require. Those of materials change looks only, and have a fallback.
void check_extensions(const json& root, const std::string& file) {
  constexpr std::array<std::string_view, 3> kKnown = {"KHR_lights_punctual", "KHR_texture_transform",
                                                      "KHR_mesh_quantization"};
  if (!root.contains("extensionsRequired")) return;
  for (size_t i = 0; i < root["extensionsRequired"].size(); ++i) {
    const auto name = root["extensionsRequired"][i].get<std::string>();
    if (name.starts_with("KHR_materials_") || std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end())
      continue;
    gltf_fail(file, fmt::format("extensionsRequired[{}]", i), fmt::format("\"{}\" is not supported", name));
  }
}

std::vector<GltfBufferInfo> buffer_infos(const json& root, bool binary, const std::string& file) {
  std::vector<GltfBufferInfo> infos;
  if (!root.contains("buffers")) return infos;
  for (size_t i = 0; i < root["buffers"].size(); ++i) {
    const json& buffer = root["buffers"][i];
    const auto uri = buffer.value("uri", std::string());
    const std::string path = fmt::format("buffers[{}]", i);
    if (uri.empty() && !(binary && i == 0)) gltf_fail(file, path + ".uri", "is missing");
    if (buffer["byteLength"].get<size_t>() == 0) gltf_fail(file, path + ".byteLength", "expected 1 or more");
    infos.push_back({buffer["byteLength"].get<size_t>(), !uri.empty() && !uri.starts_with("data:")});
  }
  return infos;
}

void check_images(const json& root, const std::string& file) {
  if (!root.contains("images")) return;
  for (size_t i = 0; i < root["images"].size(); ++i)
    if (root["images"][i].contains("uri") == root["images"][i].contains("bufferView"))
      gltf_fail(file, fmt::format("images[{}]", i), "expected either uri or bufferView");
}

bool has_primitive_without_material(const json& root) {
  if (!root.contains("meshes")) return false;
  for (const json& mesh : root["meshes"])
    for (const json& primitive : mesh["primitives"])
      if (!primitive.contains("material")) return true;
  return false;
}

}  // namespace

World read_gltf(const std::filesystem::path& path) {
  const std::string file = path.string(), bytes = read_file(path);
  const std::string_view text = gltf_json_text(bytes, file);
  const json root = parse_gltf_json(text, file);
  check_gltf_schema(root, file);
  check_extensions(root, file);
  check_buffer_views(root, file);
  check_images(root, file);

  const bool binary = text.size() != bytes.size();
  GltfContent content =
      load_gltf_content(path, bytes, buffer_infos(root, binary, file), base_color_images(root));
  const GltfBytes in{root, content.buffers, file};
  World world;
  world.name = path.stem().string();
  read_materials(in, std::move(content.images), world);
  const int default_material = static_cast<int>(world.materials.size());
  if (has_primitive_without_material(root)) world.materials.push_back({.name = "default"});
  world.meshes = read_meshes(in, default_material);
  read_scene(in, world);
  if (world.triangle_count() == 0) throw InputError(file + ": no triangles");
  return world;
}

}  // namespace vsslam

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "worlds/gltf/extras.h"
#include "worlds/gltf/parts.h"

namespace vsslam {

namespace {

using nlohmann::json;

const json kNone = json::object();

const json& below(const json& object, const char* key) {
  const auto it = object.find(key);
  return it == object.end() ? kNone : *it;
}

const json& base_color_info(const json& material) {
  return below(below(material, "pbrMetallicRoughness"), "baseColorTexture");
}
const json& texture_transform(const json& info) {
  return below(below(info, "extensions"), "KHR_texture_transform");
}

template <int N>
Eigen::Matrix<float, N, 1> vector_of(const json& object, const char* key,
                                     const Eigen::Matrix<float, N, 1>& otherwise) {
  const auto it = object.find(key);
  if (it == object.end()) return otherwise;
  Eigen::Matrix<float, N, 1> v;
  for (int i = 0; i < N; ++i) v[i] = static_cast<float>((*it)[static_cast<size_t>(i)].get<double>());
  return v;
}

// The image of a texture, -1 if it has none that we read.
int image_of(const json& root, const json& info) {
  if (!info.contains("index")) return -1;
  return root["textures"][info["index"].get<size_t>()].value("source", -1);
}

float luminance(const Vec3f& linear_rgb) {
  return linear_rgb.dot(Vec3f(0.2126f, 0.7152f, 0.0722f));
}

// Mean of up to some thousand texels, in linear light.
float mean_luminance(const Texture& texture) {
  const auto linear = [](uint8_t srgb) { return std::pow(static_cast<float>(srgb) / 255.0f, 2.2f); };
  const size_t texels = texture.rgba.size() / 4, step = std::max<size_t>(1, texels / 4096);
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < texels; i += step, ++count) {
    const uint8_t* p = &texture.rgba[4 * i];
    sum += luminance({linear(p[0]), linear(p[1]), linear(p[2])});
  }
  return count ? static_cast<float>(sum / static_cast<double>(count)) : 1.0f;
}

// Without word from the file, the LiDAR sees what the eye sees.
void guess_lidar(const json& source, const std::vector<Texture>& textures, Material& m) {
  m.lidar_albedo = luminance(m.base_color);
  if (m.base_color_texture >= 0)
    m.lidar_albedo *= mean_luminance(textures[static_cast<size_t>(m.base_color_texture)]);
  m.lidar_albedo = std::clamp(m.lidar_albedo, 0.0f, 1.0f);
  const json& transmission = below(below(source, "extensions"), "KHR_materials_transmission");
  m.glass =
      source.value("alphaMode", "OPAQUE") == "BLEND" || transmission.value("transmissionFactor", 0.0) > 0;
}

Material read_material(const GltfBytes& in, size_t index, const std::map<int, int>& texture_of_image,
                       const std::vector<Texture>& textures) {
  const json& source = in.json["materials"][index];
  const json& pbr = below(source, "pbrMetallicRoughness");
  const json& info = base_color_info(source);
  const json& transform = texture_transform(info);
  const json& strength = below(below(source, "extensions"), "KHR_materials_emissive_strength");
  Material m;
  m.name = source.value("name", "");
  m.base_color = vector_of<4>(pbr, "baseColorFactor", Eigen::Vector4f::Ones()).head<3>();
  if (const int image = image_of(in.json, info); image >= 0)
    m.base_color_texture = texture_of_image.at(image);
  m.base_color_transform = {vector_of<2>(transform, "offset", Vec2f::Zero()),
                            vector_of<2>(transform, "scale", Vec2f::Ones()),
                            static_cast<float>(transform.value("rotation", 0.0))};
  m.emissive = vector_of<3>(source, "emissiveFactor", Vec3f::Zero()) *
               static_cast<float>(strength.value("emissiveStrength", 1.0));
  m.roughness = static_cast<float>(pbr.value("roughnessFactor", 1.0));
  m.metallic = static_cast<float>(pbr.value("metallicFactor", 1.0));

  guess_lidar(source, textures, m);
  const GltfExtras extras(source, fmt::format("materials[{}]", index), in.file);
  extras.get("lidar_albedo", m.lidar_albedo);
  extras.get("retro_reflective", m.retro_reflective);
  extras.get("glass", m.glass);
  if (m.lidar_albedo < 0 || m.lidar_albedo > 1) extras.fail("lidar_albedo", "expected 0 to 1");
  return m;
}

}  // namespace

std::set<size_t> base_color_images(const json& root) {
  std::set<size_t> images;
  for (const json& material : below(root, "materials"))
    if (const int image = image_of(root, base_color_info(material)); image >= 0)
      images.insert(static_cast<size_t>(image));
  return images;
}

int base_color_texcoord(const json& root, size_t material) {
  const json& info = base_color_info(root["materials"][material]);
  return texture_transform(info).value("texCoord", info.value("texCoord", 0));
}

void read_materials(const GltfBytes& in, std::vector<Texture> images, World& world) {
  std::map<int, int> texture_of_image;
  for (const size_t image : base_color_images(in.json)) {
    texture_of_image[static_cast<int>(image)] = static_cast<int>(world.textures.size());
    world.textures.push_back(std::move(images[image]));
  }
  for (size_t i = 0; i < below(in.json, "materials").size(); ++i)
    world.materials.push_back(read_material(in, i, texture_of_image, world.textures));
}

Light read_light(const GltfBytes& in, size_t index) {
  const json& source = in.json["extensions"]["KHR_lights_punctual"]["lights"][index];
  const std::string path = fmt::format("extensions.KHR_lights_punctual.lights[{}]", index);
  const auto type = source["type"].get<std::string>();
  Light light;
  light.name = source.value("name", "");
  if (type == "directional")
    light.kind = Light::Kind::directional;
  else if (type == "spot")
    light.kind = Light::Kind::spot;
  else if (type != "point")
    gltf_fail(in.file, path + ".type", fmt::format("unknown type \"{}\"", type));
  light.color = vector_of<3>(source, "color", Vec3f::Ones());
  light.intensity = source.value("intensity", 1.0);
  light.range_m = source.value("range", 0.0);
  const json& spot = below(source, "spot");
  light.inner_cone_rad = spot.value("innerConeAngle", 0.0);
  light.outer_cone_rad = spot.value("outerConeAngle", Light{}.outer_cone_rad);
  if (light.intensity < 0) gltf_fail(in.file, path + ".intensity", "expected 0 or more");
  if (light.range_m < 0) gltf_fail(in.file, path + ".range", "expected more than 0");
  return light;
}

}  // namespace vsslam

// The only file that knows tinygltf. It decodes containers, URIs and images, and writes .glb files.
#include "worlds/gltf/gltf.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "core/errors.h"
#include "core/files.h"
#include "worlds/gltf/content.h"
#include "worlds/gltf/image_size.h"
#include "worlds/gltf/parts.h"

namespace vsslam {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

namespace {

namespace fs = std::filesystem;

constexpr int kLargestSide_px = 16384;
constexpr int64_t kMostPixels = int64_t{1} << 26;

/// What the callbacks below need to know.
struct Loading {
  std::string file;
  const std::vector<GltfBufferInfo>& buffers;
  const std::set<size_t>& wanted_images;
  size_t next_buffer = 0;  // buffers are read in order, before any image
};

bool file_exists(const std::string& path, void*) {
  return fs::is_regular_file(path);
}

// A buffer's file may be longer than the buffer; tinygltf wants it exact.
bool read_beside(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* user) {
  auto& loading = *static_cast<Loading*>(user);
  std::string bytes;
  try {
    bytes = read_file(path);
  } catch (const InputError& e) {
    *error += e.what();
    return false;
  }
  size_t& i = loading.next_buffer;
  while (i < loading.buffers.size() && !loading.buffers[i].beside) ++i;
  if (i < loading.buffers.size()) {
    const size_t length = loading.buffers[i].byte_length;
    if (bytes.size() < length)
      throw InputError(
          fmt::format("{}: buffers[{}]: {} has {} of {} bytes", loading.file, i, path, bytes.size(), length));
    bytes.resize(length);
    ++i;
  }
  out->assign(bytes.begin(), bytes.end());
  return true;
}

bool decode_image(tinygltf::Image* image, const int index, std::string* error, std::string* warning,
                  int width, int height, const unsigned char* bytes, int size, void* user) {
  const auto& loading = *static_cast<Loading*>(user);
  const auto fail = [&](const std::string& message) {
    throw InputError(fmt::format("{}: images[{}]: {}", loading.file, index, message));
  };
  if (!loading.wanted_images.contains(static_cast<size_t>(index))) return true;
  const auto found = encoded_image_size({bytes, static_cast<size_t>(std::max(size, 0))});
  if (!found) fail("neither PNG nor JPEG");
  const int64_t pixels = static_cast<int64_t>(found->width_px) * found->height_px;
  if (pixels < 1) fail("has no pixels");
  if (std::max(found->width_px, found->height_px) > kLargestSide_px || pixels > kMostPixels)
    fail(fmt::format("{} x {} pixels are too many", found->width_px, found->height_px));
  if (!tinygltf::LoadImageData(image, index, error, warning, width, height, bytes, size, nullptr))
    fail("cannot be decoded");
  return true;
}

Texture texture_of(const tinygltf::Image& image) {
  Texture texture{image.name, image.width, image.height, {}};
  if (image.bits == 8) texture.rgba = image.image;
  for (size_t i = 1; image.bits == 16 && i < image.image.size(); i += 2)
    texture.rgba.push_back(image.image[i]);  // the high byte
  return texture;
}

using Value = tinygltf::Value;

Value to_value(const Vec3& v) {
  return Value(Value::Array{Value(v.x()), Value(v.y()), Value(v.z())});
}

Value in_extras(Value::Object object) {
  return Value(Value::Object{{kGltfExtras, Value(std::move(object))}});
}

template <class Vector>
std::vector<double> doubles(const Vector& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

/// Fills a tinygltf model from a World.
class ModelWriter {
 public:
  explicit ModelWriter(const World& world) : world_(world) {
    model_.asset.version = "2.0";
    model_.asset.generator = "vsslam";
    model_.buffers.resize(1);
    for (const Texture& texture : world.textures) add_texture(texture);
    for (const Material& material : world.materials) add_material(material);
    for (const Mesh& mesh : world.meshes) add_mesh(mesh);
    for (const Object& object : world.objects) add_object(object);
    for (const Light& light : world.lights) add_light(light);
    add_scene();
  }
  const tinygltf::Model& model() const { return model_; }

 private:
  void use(const std::string& extension) {
    auto& used = model_.extensionsUsed;
    if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
  }

  // Appends bytes as a buffer view of their own, aligned to 4 bytes.
  int add_view(const void* bytes, size_t size, int target) {
    auto& data = model_.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = size;
    view.target = target;
    const auto* begin = static_cast<const unsigned char*>(bytes);
    data.insert(data.end(), begin, begin + size);
    model_.bufferViews.push_back(std::move(view));
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  int add_accessor(int view, int component_type, int type, size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component_type;
    accessor.type = type;
    accessor.count = count;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  template <int N>
  int add_vectors(const std::vector<Eigen::Matrix<float, N, 1>>& vectors) {
    const int view =
        add_view(vectors.data(), vectors.size() * sizeof(vectors[0]), TINYGLTF_TARGET_ARRAY_BUFFER);
    return add_accessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, N == 2 ? TINYGLTF_TYPE_VEC2 : TINYGLTF_TYPE_VEC3,
                        vectors.size());
  }

  void add_texture(const Texture& texture) {
    tinygltf::Image image;
    image.name = texture.name;
    image.mimeType = "image/png";
    const std::vector<uint8_t> png = encode_png(texture);
    image.bufferView = add_view(png.data(), png.size(), 0);
    model_.images.push_back(std::move(image));
    tinygltf::Texture reference;
    reference.source = static_cast<int>(model_.images.size()) - 1;
    model_.textures.push_back(std::move(reference));
  }

  static std::vector<uint8_t> encode_png(const Texture& texture) {
    tinygltf::Image image;
    image.width = texture.width_px;
    image.height = texture.height_px;
    image.component = 4;
    image.bits = 8;
    image.pixel_type = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    image.image = texture.rgba;
    const std::string folder, name = "texture.png";
    std::string uri, mime;
    std::vector<uint8_t> png;
    if (!tinygltf::WriteImageData(&folder, &name, &image, true, &uri, nullptr) ||
        !tinygltf::DecodeDataURI(&png, mime, uri, 0, false))
      throw ResourceError("cannot encode texture " + texture.name);
    return png;
  }

  void add_material(const Material& source) {
    tinygltf::Material m;
    m.name = source.name;
    auto& pbr = m.pbrMetallicRoughness;
    pbr.baseColorFactor = doubles(source.base_color);
    pbr.baseColorFactor.push_back(1.0);
    pbr.roughnessFactor = source.roughness;
    pbr.metallicFactor = source.metallic;
    pbr.baseColorTexture.index = source.base_color_texture;
    const TextureTransform& t = source.base_color_transform;
    if (source.base_color_texture >= 0 &&
        (t.offset != Vec2f::Zero() || t.scale != Vec2f::Ones() || t.rotation_rad != 0)) {
      use("KHR_texture_transform");
      pbr.baseColorTexture.extensions["KHR_texture_transform"] = Value(Value::Object{
          {"offset", Value(Value::Array{Value(double{t.offset.x()}), Value(double{t.offset.y()})})},
          {"scale", Value(Value::Array{Value(double{t.scale.x()}), Value(double{t.scale.y()})})},
          {"rotation", Value(double{t.rotation_rad})}});
    }
    // A factor is at most 1. Dividing by a power of two loses nothing.
    double strength = 1;
    while (source.emissive.maxCoeff() > strength) strength *= 2;
    m.emissiveFactor = doubles(source.emissive);
    for (double& e : m.emissiveFactor) e /= strength;
    if (strength > 1) {
      use("KHR_materials_emissive_strength");
      m.extensions["KHR_materials_emissive_strength"] =
          Value(Value::Object{{"emissiveStrength", Value(strength)}});
    }
    m.extras = in_extras({{"lidar_albedo", Value(double{source.lidar_albedo})},
                          {"retro_reflective", Value(source.retro_reflective)},
                          {"glass", Value(source.glass)}});
    model_.materials.push_back(std::move(m));
  }

  void add_mesh(const Mesh& source) {
    tinygltf::Mesh mesh;
    mesh.name = source.name;
    for (const Primitive& p : source.primitives) {
      tinygltf::Primitive primitive;
      primitive.material = p.material;
      primitive.mode = TINYGLTF_MODE_TRIANGLES;
      primitive.attributes["POSITION"] = add_positions(p.positions);
      std::vector<Vec3f> normals = p.normals;
      for (Vec3f& n : normals) n = y_up(n);
      primitive.attributes["NORMAL"] = add_vectors<3>(normals);
      if (!p.uvs.empty()) primitive.attributes["TEXCOORD_0"] = add_vectors<2>(p.uvs);
      primitive.indices = add_indices(p);
      mesh.primitives.push_back(std::move(primitive));
    }
    model_.meshes.push_back(std::move(mesh));
  }

  int add_positions(const std::vector<Vec3f>& positions_z_up) {
    std::vector<Vec3f> positions = positions_z_up;
    Vec3f low = Vec3f::Constant(std::numeric_limits<float>::max()), high = -low;
    for (Vec3f& p : positions) {
      p = y_up(p);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const int accessor = add_vectors<3>(positions);
    model_.accessors.back().minValues = doubles(low);
    model_.accessors.back().maxValues = doubles(high);
    return accessor;
  }

  int add_indices(const Primitive& p) {
    const size_t count = 3 * p.triangles.size();
    if (p.positions.size() >= 0xFFFF) {
      const int view = add_view(p.triangles.data(), count * 4, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
      return add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, count);
    }
    std::vector<uint16_t> narrow;
    narrow.reserve(count);
    for (const auto& t : p.triangles)
      for (const uint32_t v : t) narrow.push_back(static_cast<uint16_t>(v));
    const int view = add_view(narrow.data(), count * 2, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    return add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR, count);
  }

  void add_object(const Object& object) {
    tinygltf::Node node;
    node.name = object.name;
    node.mesh = object.mesh;
    if (!object.T_world_object.matrix().isIdentity(0))
      node.matrix = doubles(y_up(object.T_world_object).matrix());
    if (object.collision == Collision::none)
      node.extras = in_extras({{"collision", Value(std::string("none"))}});
    model_.nodes.push_back(std::move(node));
  }

  void add_light(const Light& source) {
    tinygltf::Light light;
    light.name = source.name;
    light.type = source.kind == Light::Kind::spot    ? "spot"
                 : source.kind == Light::Kind::point ? "point"
                                                     : "directional";
    light.color = doubles(source.color);
    light.intensity = source.intensity;
    light.range = source.range_m;
    light.spot.innerConeAngle = source.inner_cone_rad;
    light.spot.outerConeAngle = source.outer_cone_rad;
    model_.lights.push_back(std::move(light));
    use("KHR_lights_punctual");

    tinygltf::Node node;
    node.name = source.name;
    node.matrix = doubles(light_frame(source).matrix());
    node.extensions["KHR_lights_punctual"] =
        Value(Value::Object{{"light", Value(static_cast<int>(model_.lights.size()) - 1)}});
    node.extras =
        in_extras({{"light_group", Value(source.group)}, {"light_radius_m", Value(source.radius_m)}});
    model_.nodes.push_back(std::move(node));
  }

  // glTF's lights shine along -z of their node; its other axes do not matter.
  static Eigen::Affine3d light_frame(const Light& light) {
    const Vec3 z = -y_up(light.direction_world);
    const Vec3 x = z.unitOrthogonal();
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.linear().col(0) = x;
    T.linear().col(1) = z.cross(x);
    T.linear().col(2) = z;
    T.translation() = y_up(light.position_world);
    return T;
  }

  void add_scene() {
    tinygltf::Scene scene;
    scene.name = world_.name;
    for (size_t i = 0; i < model_.nodes.size(); ++i) scene.nodes.push_back(static_cast<int>(i));
    const Floor& f = world_.floor;
    Value::Array routes;
    for (const Route& route : world_.routes) {
      Value::Array points;
      for (const Vec3& p : route.points_world) points.push_back(to_value(p));
      Value::Object written{{"name", Value(route.name)}, {"closed", Value(route.closed)}};
      if (!points.empty()) written["points_world"] = Value(std::move(points));
      routes.push_back(Value(std::move(written)));
    }
    // A seed has 64 bits, more than a number of tinygltf: it travels as text.
    Value::Object extras{{"floor", Value(Value::Object{{"height_m", Value(f.height_m)},
                                                       {"unevenness_m", Value(f.unevenness_m)},
                                                       {"wavelength_m", Value(f.wavelength_m)},
                                                       {"seed", Value(std::to_string(f.seed))}})}};
    // tinygltf would write an empty list as null.
    if (!routes.empty()) extras["routes"] = Value(std::move(routes));
    scene.extras = in_extras(std::move(extras));
    model_.scenes.push_back(std::move(scene));
    model_.defaultScene = 0;
  }

  const World& world_;
  tinygltf::Model model_;
};

}  // namespace

void write_glb(const World& world, const fs::path& path) {
  const ModelWriter writer(world);
  std::ostringstream stream;
  tinygltf::TinyGLTF output;
  if (!output.WriteGltfSceneToStream(&writer.model(), stream, false, true))
    throw ResourceError(path.string() + ": cannot be written");
  write_file(path, stream.view());
}

GltfContent load_gltf_content(const fs::path& path, std::string_view bytes,
                              const std::vector<GltfBufferInfo>& buffers,
                              const std::set<size_t>& wanted_images) {
  if (bytes.size() > std::numeric_limits<uint32_t>::max())
    throw InputError(path.string() + ": larger than 4 GB");
  Loading loading{path.string(), buffers, wanted_images};
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(decode_image, &loading);
  reader.SetFsCallbacks({file_exists, tinygltf::ExpandFilePath, read_beside, nullptr, &loading});
  tinygltf::Model model;
  std::string error, warning;
  const auto size = static_cast<unsigned int>(bytes.size());
  const bool binary = bytes.starts_with("glTF");
  const bool ok = binary ? reader.LoadBinaryFromMemory(&model, &error, &warning,
                                                       reinterpret_cast<const unsigned char*>(bytes.data()),
                                                       size, path.parent_path().string())
                         : reader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size,
                                                      path.parent_path().string());
  while (!error.empty() && std::isspace(static_cast<unsigned char>(error.back()))) error.pop_back();
  if (!ok || model.buffers.size() != buffers.size())
    throw InputError(fmt::format("{}: {}", path.string(), error.empty() ? "cannot be read" : error));

  GltfContent content;
  for (size_t i = 0; i < model.buffers.size(); ++i) {
    if (model.buffers[i].data.size() < buffers[i].byte_length)
      throw InputError(fmt::format("{}: buffers[{}]: {} of {} bytes", path.string(), i,
                                   model.buffers[i].data.size(), buffers[i].byte_length));
    content.buffers.push_back(std::move(model.buffers[i].data));
  }
  for (size_t i = 0; i < model.images.size(); ++i) {
    if (wanted_images.contains(i) && model.images[i].image.empty())
      throw InputError(
          fmt::format("{}: images[{}]: cannot read \"{}\"", path.string(), i, model.images[i].uri));
    content.images.push_back(texture_of(model.images[i]));
  }
  return content;
}

}  // namespace vsslam

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "worlds/gltf/parts.h"
#include "worlds/gltf/schema.h"

namespace vsslam {

namespace {

using nlohmann::json;

constexpr int kTriangles = 4, kStrip = 5, kFan = 6;
constexpr size_t kMostVertices = size_t{1} << 28;  // of one file; primitives may share arrays

template <int N>
std::vector<Eigen::Matrix<float, N, 1>> read_vectors(const GltfBytes& in, size_t accessor,
                                                     const std::string& path) {
  const std::vector<float> flat = read_floats(in, accessor, N, path);
  std::vector<Eigen::Matrix<float, N, 1>> vectors(flat.size() / N);
  for (size_t i = 0; i < vectors.size(); ++i) {
    vectors[i] = Eigen::Map<const Eigen::Matrix<float, N, 1>>(&flat[i * N]);
    if (!vectors[i].allFinite())
      gltf_fail(in.file, path, fmt::format("accessors[{}]: element {} is not finite", accessor, i));
  }
  return vectors;
}

// Triangles of a list, strip or fan; those that use a vertex twice are dropped.
std::vector<std::array<uint32_t, 3>> assemble(const std::vector<uint32_t>& indices, int mode) {
  std::vector<std::array<uint32_t, 3>> triangles;
  const size_t n = indices.size();
  const size_t count = mode == kTriangles ? n / 3 : n < 3 ? 0 : n - 2;
  triangles.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    std::array<uint32_t, 3> t;
    if (mode == kTriangles)
      t = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
    else if (mode == kStrip)
      t = {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]};
    else
      t = {indices[i + 1], indices[i + 2], indices[0]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

// Many primitives may cut their triangles from one large vertex array: keep what this one uses.
void drop_unused_vertices(Primitive& p) {
  std::vector<uint32_t> renumbered(p.positions.size(), 0);
  for (const auto& t : p.triangles)
    for (const uint32_t v : t) renumbered[v] = 1;
  const auto used = std::accumulate(renumbered.begin(), renumbered.end(), size_t{0});
  if (used == p.positions.size()) return;
  uint32_t next = 0;
  for (uint32_t v = 0; v < renumbered.size(); ++v) {
    if (!renumbered[v]) continue;
    p.positions[next] = p.positions[v];
    if (!p.normals.empty()) p.normals[next] = p.normals[v];
    if (!p.uvs.empty()) p.uvs[next] = p.uvs[v];
    renumbered[v] = next++;
  }
  p.positions.resize(used);
  if (!p.normals.empty()) p.normals.resize(used);
  if (!p.uvs.empty()) p.uvs.resize(used);
  for (auto& t : p.triangles)
    for (uint32_t& v : t) v = renumbered[v];
}

// Without normals glTF asks for flat shading: every triangle gets vertices of its own.
void flat_normals(Primitive& p) {
  Primitive flat{.material = p.material, .positions = {}, .normals = {}, .uvs = {}, .triangles = {}};
  for (const auto& t : p.triangles) {
    const Vec3f n = (p.positions[t[1]] - p.positions[t[0]]).cross(p.positions[t[2]] - p.positions[t[0]]);
    const float length = n.stableNorm();
    const auto first = static_cast<uint32_t>(flat.positions.size());
    for (const uint32_t v : t) {
      flat.positions.push_back(p.positions[v]);
      flat.normals.push_back(length > 0 ? Vec3f(n / length) : Vec3f(Vec3f::UnitZ()));
      if (!p.uvs.empty()) flat.uvs.push_back(p.uvs[v]);
    }
    flat.triangles.push_back({first, first + 1, first + 2});
  }
  p = std::move(flat);
}

// Unit normals stay as they are, to the bit; others are scaled. False if one has no direction.
bool normalize(std::vector<Vec3f>& normals) {
  for (Vec3f& n : normals) {
    const float length = n.stableNorm();
    if (!(length > 1e-6f)) return false;
    if (std::abs(length - 1) > 1e-4f) n /= length;
  }
  return true;
}

class MeshReader {
 public:
  MeshReader(const GltfBytes& in, int default_material) : in_(in), default_material_(default_material) {}

  Mesh read(size_t index) {
    const json& source = in_.json["meshes"][index];
    Mesh mesh{.name = source.value("name", ""), .primitives = {}};
    for (size_t k = 0; k < source["primitives"].size(); ++k) {
      const json& primitive = source["primitives"][k];
      const int mode = primitive.value("mode", kTriangles);
      path_ = fmt::format("meshes[{}].primitives[{}]", index, k);
      if (mode > kFan) gltf_fail(in_.file, path_ + ".mode", fmt::format("unknown mode {}", mode));
      if (mode < kTriangles || !primitive["attributes"].contains("POSITION")) continue;
      Primitive read = read_primitive(primitive, mode);
      if (!read.triangles.empty()) mesh.primitives.push_back(std::move(read));
    }
    return mesh;
  }

 private:
  Primitive read_primitive(const json& source, int mode) {
    const json& attributes = source["attributes"];
    Primitive p;
    p.material = source.value("material", default_material_);
    count_vertices(attributes["POSITION"].get<size_t>());
    p.positions = read_vectors<3>(in_, attributes["POSITION"].get<size_t>(), path_ + ".attributes.POSITION");
    const std::string uv = fmt::format(
        "TEXCOORD_{}",
        source.contains("material") ? base_color_texcoord(in_.json, source["material"].get<size_t>()) : 0);
    if (attributes.contains(uv)) p.uvs = read_attribute<2>(attributes, uv.c_str(), p.positions.size());
    if (attributes.contains("NORMAL"))
      p.normals = read_attribute<3>(attributes, "NORMAL", p.positions.size());
    for (Vec3f& v : p.positions) v = z_up(v);
    for (Vec3f& n : p.normals) n = z_up(n);
    p.triangles = assemble(read_order(source, p.positions.size()), mode);
    drop_unused_vertices(p);
    if (p.normals.empty() || !normalize(p.normals)) flat_normals(p);
    return p;
  }

  template <int N>
  std::vector<Eigen::Matrix<float, N, 1>> read_attribute(const json& attributes, const char* name,
                                                         size_t vertices) {
    const std::string path = fmt::format("{}.attributes.{}", path_, name);
    const size_t accessor = attributes[name].get<size_t>();
    if (accessor_count(in_, accessor) != vertices)
      gltf_fail(in_.file, path,
                fmt::format("{} elements for {} vertices", accessor_count(in_, accessor), vertices));
    return read_vectors<N>(in_, accessor, path);
  }

  std::vector<uint32_t> read_order(const json& source, size_t vertices) {
    if (source.contains("indices")) {
      const size_t accessor = source["indices"].get<size_t>();
      count_vertices(accessor);
      return read_indices(in_, accessor, vertices, path_ + ".indices");
    }
    std::vector<uint32_t> order(vertices);
    std::iota(order.begin(), order.end(), 0u);
    return order;
  }

  void count_vertices(size_t accessor) {
    vertices_ += accessor_count(in_, accessor);
    if (vertices_ > kMostVertices) gltf_fail(in_.file, path_, "too many vertices in all");
  }

  const GltfBytes& in_;
  int default_material_;
  std::string path_;
  size_t vertices_ = 0;
};

}  // namespace

std::vector<Mesh> read_meshes(const GltfBytes& in, int default_material) {
  std::vector<Mesh> meshes;
  MeshReader reader(in, default_material);
  const size_t count = in.json.contains("meshes") ? in.json["meshes"].size() : 0;
  for (size_t i = 0; i < count; ++i) meshes.push_back(reader.read(i));
  return meshes;
}

}  // namespace vsslam

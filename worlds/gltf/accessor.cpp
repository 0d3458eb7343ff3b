#include "worlds/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "worlds/gltf/schema.h"

namespace vsslam {

namespace {

using nlohmann::json;

constexpr size_t kMostElementsWithoutBytes = size_t{1} << 24;  // an accessor without a buffer view is zeros

size_t member(const json& object, const char* key) {
  return object.value(key, size_t{0});
}

size_t component_bytes(int type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

int components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  return type == "MAT3" ? 9 : type == "MAT4" ? 16 : 0;
}

/// Equally spaced elements inside a buffer.
struct Elements {
  std::span<const uint8_t> bytes;
  size_t stride = 0, count = 0;
  int component_type = 0, components = 0;
};

// The part of a buffer view that `count` elements from `offset` on take; throws if they do not fit.
Elements elements_in(const GltfBytes& in, size_t view_index, size_t offset, size_t count, int component_type,
                     int components, const std::string& path) {
  const json& view = in.json["bufferViews"][view_index];
  const auto& buffer = in.buffers[view["buffer"].get<size_t>()];
  const size_t element = component_bytes(component_type) * static_cast<size_t>(components);
  const size_t stride = member(view, "byteStride") ? member(view, "byteStride") : element;
  const size_t length = member(view, "byteLength");
  if (stride < element)
    gltf_fail(in.file, path,
              fmt::format("byteStride {} is less than an element's {} bytes", stride, element));
  // All values are below 2^31, so nothing overflows.
  if (count > 0 && offset + stride * (count - 1) + element > length)
    gltf_fail(
        in.file, path,
        fmt::format("{} elements do not fit into bufferViews[{}] ({} bytes)", count, view_index, length));
  const auto whole = std::span<const uint8_t>(buffer).subspan(member(view, "byteOffset"), length);
  return {count ? whole.subspan(offset) : std::span<const uint8_t>{}, stride, count, component_type,
          components};
}

template <class T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <class Stored, class Out>
void convert(const Elements& e, bool normalized, Out* out) {
  for (size_t i = 0; i < e.count; ++i)
    for (int c = 0; c < e.components; ++c) {
      const auto stored =
          load<Stored>(e.bytes.data() + i * e.stride + static_cast<size_t>(c) * sizeof(Stored));
      if constexpr (std::is_integral_v<Stored> && std::is_floating_point_v<Out>) {
        constexpr auto kMost = static_cast<Out>(std::numeric_limits<Stored>::max());
        *out++ = normalized ? std::max(static_cast<Out>(stored) / kMost, Out(-1)) : static_cast<Out>(stored);
      } else {
        *out++ = static_cast<Out>(stored);
      }
    }
}

template <class Out>
std::vector<Out> read_elements(const Elements& e, bool normalized) {
  std::vector<Out> out(e.count * static_cast<size_t>(e.components));
  switch (e.component_type) {
    case 5120:
      convert<int8_t>(e, normalized, out.data());
      break;
    case 5121:
      convert<uint8_t>(e, normalized, out.data());
      break;
    case 5122:
      convert<int16_t>(e, normalized, out.data());
      break;
    case 5123:
      convert<uint16_t>(e, normalized, out.data());
      break;
    case 5125:
      convert<uint32_t>(e, normalized, out.data());
      break;
    default:
      if constexpr (std::is_floating_point_v<Out>) convert<float>(e, normalized, out.data());
  }
  return out;
}

// Replaces single elements, see "sparse accessors" of the glTF 2.0 specification.
template <class Out>
void apply_sparse(const GltfBytes& in, const json& accessor, const std::string& path, int type,
                  int components, std::vector<Out>& out) {
  const json& sparse = accessor["sparse"];
  const size_t count = member(sparse, "count"), total = member(accessor, "count");
  if (count > total)
    gltf_fail(in.file, path + ".sparse.count", fmt::format("{} of {} elements", count, total));
  const json& indices = sparse["indices"];
  const int index_type = indices["componentType"].get<int>();
  if (index_type != 5121 && index_type != 5123 && index_type != 5125)
    gltf_fail(in.file, path + ".sparse.indices.componentType", "expected an unsigned type");
  const auto places = read_elements<uint32_t>(
      elements_in(in, indices["bufferView"].get<size_t>(), member(indices, "byteOffset"), count, index_type,
                  1, path + ".sparse.indices"),
      false);
  const json& values = sparse["values"];
  const auto replaced =
      read_elements<Out>(elements_in(in, values["bufferView"].get<size_t>(), member(values, "byteOffset"),
                                     count, type, components, path + ".sparse.values"),
                         accessor.value("normalized", false));
  const auto width = static_cast<size_t>(components);
  for (size_t i = 0; i < count; ++i) {
    if (places[i] >= total)
      gltf_fail(in.file, path + ".sparse.indices",
                fmt::format("index {} out of range ({} elements)", places[i], total));
    std::copy_n(replaced.begin() + static_cast<std::ptrdiff_t>(i * width), width,
                out.begin() + static_cast<std::ptrdiff_t>(places[i] * width));
  }
}

template <class Out>
std::vector<Out> read_accessor(const GltfBytes& in, size_t index, int components) {
  const json& accessor = in.json["accessors"][index];
  const std::string path = fmt::format("accessors[{}]", index);
  const int type = accessor["componentType"].get<int>();
  const size_t count = member(accessor, "count");
  std::vector<Out> out;
  if (accessor.contains("bufferView")) {
    out = read_elements<Out>(elements_in(in, accessor["bufferView"].get<size_t>(),
                                         member(accessor, "byteOffset"), count, type, components, path),
                             accessor.value("normalized", false));
  } else {
    if (count > kMostElementsWithoutBytes)
      gltf_fail(in.file, path + ".count", fmt::format("{} elements without a buffer view", count));
    out.assign(count * static_cast<size_t>(components), Out{});
  }
  if (accessor.contains("sparse")) apply_sparse(in, accessor, path, type, components, out);
  return out;
}

void check_type(const GltfBytes& in, size_t index, int components, const std::string& used_as) {
  const json& accessor = in.json["accessors"][index];
  const std::string path = fmt::format("accessors[{}]", index), type = accessor["type"].get<std::string>();
  if (component_bytes(accessor["componentType"].get<int>()) == 0)
    gltf_fail(in.file, path + ".componentType",
              fmt::format("unknown type {}", accessor["componentType"].get<int>()));
  if (components_of(type) != components || type.starts_with("MAT"))
    gltf_fail(in.file, path + ".type", fmt::format("\"{}\" is not what {} needs", type, used_as));
  if (member(accessor, "count") == 0) gltf_fail(in.file, path + ".count", "expected 1 or more");
}

}  // namespace

void check_buffer_views(const json& root, const std::string& file) {
  if (!root.contains("bufferViews")) return;
  for (size_t i = 0; i < root["bufferViews"].size(); ++i) {
    const json& view = root["bufferViews"][i];
    const size_t buffer = view["buffer"].get<size_t>(), size = member(root["buffers"][buffer], "byteLength");
    const size_t end = member(view, "byteOffset") + member(view, "byteLength");
    const std::string path = fmt::format("bufferViews[{}]", i);
    if (end > size)
      gltf_fail(file, path,
                fmt::format("ends at byte {}, past the end of buffers[{}] ({} bytes)", end, buffer, size));
    if (member(view, "byteLength") == 0) gltf_fail(file, path + ".byteLength", "expected 1 or more");
    if (member(view, "byteStride") > 252) gltf_fail(file, path + ".byteStride", "expected at most 252");
  }
}

size_t accessor_count(const GltfBytes& in, size_t accessor) {
  return member(in.json["accessors"][accessor], "count");
}

std::vector<float> read_floats(const GltfBytes& in, size_t accessor, int components,
                               const std::string& used_as) {
  check_type(in, accessor, components, used_as);
  return read_accessor<float>(in, accessor, components);
}

std::vector<uint32_t> read_indices(const GltfBytes& in, size_t index, size_t limit,
                                   const std::string& used_as) {
  check_type(in, index, 1, used_as);
  const int type = in.json["accessors"][index]["componentType"].get<int>();
  const std::string path = fmt::format("accessors[{}]", index);
  if (type != 5121 && type != 5123 && type != 5125)
    gltf_fail(in.file, path + ".componentType", fmt::format("{} needs an unsigned type", used_as));
  std::vector<uint32_t> indices = read_accessor<uint32_t>(in, index, 1);
  for (const uint32_t i : indices)
    if (i >= limit) gltf_fail(in.file, path, fmt::format("index {} out of range ({} vertices)", i, limit));
  return indices;
}

}  // namespace vsslam

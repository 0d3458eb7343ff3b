// Builds small .gltf files whose buffers are data URIs, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/files.h"
#include "tests/scratch.h"

namespace vsslam {

inline std::string base64(const std::vector<uint8_t>& bytes) {
  static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const uint32_t left = static_cast<uint32_t>(bytes.size() - i);
    const uint32_t word = static_cast<uint32_t>(bytes[i]) << 16 |
                          (left > 1 ? static_cast<uint32_t>(bytes[i + 1]) << 8 : 0) |
                          (left > 2 ? static_cast<uint32_t>(bytes[i + 2]) : 0);
    for (uint32_t k = 0; k < 4; ++k) text += k <= left ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A .gltf in the making: one buffer, one view per array unless told otherwise.
struct GltfText {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                         {"scene", 0},
                         {"scenes", {{{"nodes", {0}}}}},
                         {"nodes", {{{"mesh", 0}}}}};
  std::vector<uint8_t> bytes;

  template <class T>
  size_t add_view(const std::vector<T>& values, size_t stride = 0) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const size_t offset = bytes.size();
    bytes.resize(offset + values.size() * sizeof(T));
    std::memcpy(bytes.data() + offset, values.data(), values.size() * sizeof(T));
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}};
    if (stride) view["byteStride"] = stride;
    json["bufferViews"].push_back(view);
    return json["bufferViews"].size() - 1;
  }
  size_t add_accessor(size_t view, int component_type, const char* type, size_t count, size_t offset = 0) {
    json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component_type},
                                 {"type", type},
                                 {"count", count},
                                 {"byteOffset", offset}});
    return json["accessors"].size() - 1;
  }
  /// Adds a mesh of one primitive.
  nlohmann::json& add_primitive(const nlohmann::json& attributes) {
    json["meshes"].push_back({{"primitives", {{{"attributes", attributes}}}}});
    return json["meshes"].back()["primitives"][0];
  }
  /// One triangle (0 0 0) (1 0 0) (0 1 0) of glTF's frame.
  static GltfText triangle() {
    GltfText text;
    const size_t positions =
        text.add_accessor(text.add_view<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), 5126, "VEC3", 3);
    text.add_primitive({{"POSITION", positions}});
    return text;
  }

  std::string dump() const {
    nlohmann::json whole = json;
    if (!whole.contains("buffers") && !bytes.empty())
      whole["buffers"] = {
          {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    return whole.dump();
  }
  std::filesystem::path write(const std::string& name) const {
    const std::filesystem::path path = scratch_folder() / name;
    write_file(path, dump());
    return path;
  }
};

}  // namespace vsslam

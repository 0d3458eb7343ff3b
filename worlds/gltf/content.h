// What a glTF file holds besides its JSON: the bytes of its buffers and its decoded images.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "worlds/world.h"

namespace vsslam {

struct GltfBufferInfo {
  size_t byte_length = 0;
  bool beside = false;  ///< in a file of its own
};

struct GltfContent {
  std::vector<std::vector<uint8_t>> buffers;  ///< each exactly its byteLength long
  std::vector<Texture> images;                ///< one per image; empty unless wanted
};

/// Loads buffers (inside the file, data URIs, files beside it) and decodes the wanted images (PNG, JPEG).
/// The JSON must have passed check_gltf_schema and check_buffer_views.
GltfContent load_gltf_content(const std::filesystem::path& path, std::string_view bytes,
                              const std::vector<GltfBufferInfo>& buffers,
                              const std::set<size_t>& wanted_images);

}  // namespace vsslam

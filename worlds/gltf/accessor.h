// Typed arrays of a glTF file, checked against their buffers before anything is read or allocated.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace vsslam {

/// The file's JSON (schema checked), its buffers, and its name for messages.
struct GltfBytes {
  const nlohmann::json& json;
  const std::vector<std::vector<uint8_t>>& buffers;
  const std::string& file;
};

/// Checks all buffer views against their buffers' byteLength. Call before buffers are loaded.
void check_buffer_views(const nlohmann::json& json, const std::string& file);

/// Number of elements.
size_t accessor_count(const GltfBytes& bytes, size_t accessor);

/// Elements one after another as float; integers converted, normalised ones to [0, 1] or [-1, 1].
/// `used_as` names who asks, for messages. Throws InputError unless the type is VEC<components> (SCALAR for
/// 1) and everything lies inside its buffer.
std::vector<float> read_floats(const GltfBytes& bytes, size_t accessor, int components,
                               const std::string& used_as);

/// Unsigned indices, each below `limit`.
std::vector<uint32_t> read_indices(const GltfBytes& bytes, size_t accessor, size_t limit,
                                   const std::string& used_as);

}  // namespace vsslam

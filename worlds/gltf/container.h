// The container of a .glb: a header, a chunk of JSON, a chunk of bytes.
#pragma once

#include <string>
#include <string_view>

namespace vsslam {

/// The JSON text inside a .glb, or the whole text of a .gltf. Throws InputError if the container is broken.
std::string_view gltf_json_text(std::string_view bytes, const std::string& file);

}  // namespace vsslam

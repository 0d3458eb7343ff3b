// Checks the JSON of a glTF file before anything relies on it: types, required members, and that every index
// points into its array.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace vsslam {

/// Throws InputError "file: path: message".
[[noreturn]] void gltf_fail(const std::string& file, const std::string& path, const std::string& message);

/// Parses the text of a glTF; throws InputError for broken or absurdly nested JSON.
nlohmann::json parse_gltf_json(std::string_view text, const std::string& file);

/// Throws InputError naming `file` and the JSON path.
void check_gltf_schema(const nlohmann::json& root, const std::string& file);

}  // namespace vsslam

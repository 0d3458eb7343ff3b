// Typed look-ups in the `extras` of a glTF part, with an error that names the place.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "worlds/gltf/schema.h"

namespace vsslam {

class GltfExtras {
 public:
  /// `owner` may have extras.<kGltfExtras>; `path` names it in messages.
  GltfExtras(const nlohmann::json& owner, const std::string& path, const std::string& file);

  bool has(const char* key) const { return values_ && values_->contains(key); }
  const nlohmann::json& at(const char* key) const { return (*values_)[key]; }
  std::string place(const char* key) const { return path_ + "." + key; }

  void get(const char* key, bool& value) const;
  void get(const char* key, double& value) const;  ///< finite
  void get(const char* key, float& value) const;
  void get(const char* key, std::string& value) const;

  [[noreturn]] void fail(const char* key, const std::string& message) const {
    gltf_fail(file_, place(key), message);
  }

 private:
  const nlohmann::json* values_ = nullptr;
  std::string path_, file_;
};

}  // namespace vsslam

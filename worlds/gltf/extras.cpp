#include "worlds/gltf/extras.h"

#include <cmath>

#include "worlds/gltf/parts.h"

namespace vsslam {

GltfExtras::GltfExtras(const nlohmann::json& owner, const std::string& path, const std::string& file)
    : path_(path + ".extras." + kGltfExtras), file_(file) {
  const auto extras = owner.find("extras");
  if (extras == owner.end() || !extras->is_object()) return;  // others may put anything there
  const auto ours = extras->find(kGltfExtras);
  if (ours == extras->end()) return;
  if (!ours->is_object()) gltf_fail(file_, path_, "expected an object");
  values_ = &*ours;
}

void GltfExtras::get(const char* key, bool& value) const {
  if (!has(key)) return;
  if (!at(key).is_boolean()) fail(key, "expected true or false");
  value = at(key).get<bool>();
}

void GltfExtras::get(const char* key, double& value) const {
  if (!has(key)) return;
  if (!at(key).is_number() || !std::isfinite(at(key).get<double>())) fail(key, "expected a finite number");
  value = at(key).get<double>();
}

void GltfExtras::get(const char* key, float& value) const {
  double wide = value;
  get(key, wide);
  if (std::abs(wide) > 3e38) fail(key, "too large");
  value = static_cast<float>(wide);
}

void GltfExtras::get(const char* key, std::string& value) const {
  if (!has(key)) return;
  if (!at(key).is_string()) fail(key, "expected a text");
  value = at(key).get<std::string>();
}

}  // namespace vsslam

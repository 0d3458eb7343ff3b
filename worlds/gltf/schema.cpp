#include "worlds/gltf/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/errors.h"

namespace vsslam {

namespace {

using nlohmann::json;

constexpr int kDeepestJson = 64;

enum class Kind { object, array, text, boolean, count, number, numbers, index, indices };

/// What stands at a path. "a[].b" is member b of every item of array a, "a{}" every member of object a.
struct Rule {
  const char* path;
  Kind kind;
  const char* into = "";  ///< for indices: the array at the root that they point into
  size_t size = 0;        ///< for numbers: how many
  bool required = false;
};

constexpr bool kRequired = true;
constexpr const char* kLights = "extensions.KHR_lights_punctual.lights";

const Rule kRules[] = {
    {"asset", Kind::object, "", 0, kRequired},
    {"asset.version", Kind::text, "", 0, kRequired},
    {"extensionsUsed[]", Kind::text},
    {"extensionsRequired[]", Kind::text},
    {"scene", Kind::index, "scenes"},
    {"scenes[]", Kind::object},
    {"scenes[].name", Kind::text},
    {"scenes[].nodes", Kind::indices, "nodes"},
    {"nodes[]", Kind::object},
    {"nodes[].name", Kind::text},
    {"nodes[].children", Kind::indices, "nodes"},
    {"nodes[].mesh", Kind::index, "meshes"},
    {"nodes[].matrix", Kind::numbers, "", 16},
    {"nodes[].translation", Kind::numbers, "", 3},
    {"nodes[].rotation", Kind::numbers, "", 4},
    {"nodes[].scale", Kind::numbers, "", 3},
    {"nodes[].extensions", Kind::object},
    {"nodes[].extensions.KHR_lights_punctual", Kind::object},
    {"nodes[].extensions.KHR_lights_punctual.light", Kind::index, kLights, 0, kRequired},
    {"meshes[]", Kind::object},
    {"meshes[].name", Kind::text},
    {"meshes[].primitives", Kind::array, "", 0, kRequired},
    {"meshes[].primitives[]", Kind::object},
    {"meshes[].primitives[].attributes", Kind::object, "", 0, kRequired},
    {"meshes[].primitives[].attributes{}", Kind::index, "accessors"},
    {"meshes[].primitives[].indices", Kind::index, "accessors"},
    {"meshes[].primitives[].material", Kind::index, "materials"},
    {"meshes[].primitives[].mode", Kind::count},
    {"accessors[]", Kind::object},
    {"accessors[].bufferView", Kind::index, "bufferViews"},
    {"accessors[].byteOffset", Kind::count},
    {"accessors[].count", Kind::count, "", 0, kRequired},
    {"accessors[].componentType", Kind::count, "", 0, kRequired},
    {"accessors[].type", Kind::text, "", 0, kRequired},
    {"accessors[].normalized", Kind::boolean},
    {"accessors[].sparse", Kind::object},
    {"accessors[].sparse.count", Kind::count, "", 0, kRequired},
    {"accessors[].sparse.indices", Kind::object, "", 0, kRequired},
    {"accessors[].sparse.indices.bufferView", Kind::index, "bufferViews", 0, kRequired},
    {"accessors[].sparse.indices.byteOffset", Kind::count},
    {"accessors[].sparse.indices.componentType", Kind::count, "", 0, kRequired},
    {"accessors[].sparse.values", Kind::object, "", 0, kRequired},
    {"accessors[].sparse.values.bufferView", Kind::index, "bufferViews", 0, kRequired},
    {"accessors[].sparse.values.byteOffset", Kind::count},
    {"bufferViews[]", Kind::object},
    {"bufferViews[].buffer", Kind::index, "buffers", 0, kRequired},
    {"bufferViews[].byteOffset", Kind::count},
    {"bufferViews[].byteLength", Kind::count, "", 0, kRequired},
    {"bufferViews[].byteStride", Kind::count},
    {"buffers[]", Kind::object},
    {"buffers[].byteLength", Kind::count, "", 0, kRequired},
    {"buffers[].uri", Kind::text},
    {"materials[]", Kind::object},
    {"materials[].name", Kind::text},
    {"materials[].alphaMode", Kind::text},
    {"materials[].emissiveFactor", Kind::numbers, "", 3},
    {"materials[].pbrMetallicRoughness", Kind::object},
    {"materials[].pbrMetallicRoughness.baseColorFactor", Kind::numbers, "", 4},
    {"materials[].pbrMetallicRoughness.metallicFactor", Kind::number},
    {"materials[].pbrMetallicRoughness.roughnessFactor", Kind::number},
    {"materials[].pbrMetallicRoughness.baseColorTexture", Kind::object},
    {"materials[].pbrMetallicRoughness.baseColorTexture.index", Kind::index, "textures", 0, kRequired},
    {"materials[].pbrMetallicRoughness.baseColorTexture.texCoord", Kind::count},
    {"materials[].pbrMetallicRoughness.baseColorTexture.extensions", Kind::object},
    {"materials[].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform", Kind::object},
    {"materials[].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform.offset",
     Kind::numbers, "", 2},
    {"materials[].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform.scale",
     Kind::numbers, "", 2},
    {"materials[].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform.rotation",
     Kind::number},
    {"materials[].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform.texCoord",
     Kind::count},
    {"materials[].extensions", Kind::object},
    {"materials[].extensions.KHR_materials_transmission", Kind::object},
    {"materials[].extensions.KHR_materials_transmission.transmissionFactor", Kind::number},
    {"materials[].extensions.KHR_materials_emissive_strength", Kind::object},
    {"materials[].extensions.KHR_materials_emissive_strength.emissiveStrength", Kind::number},
    {"textures[]", Kind::object},
    {"textures[].source", Kind::index, "images"},
    {"images[]", Kind::object},
    {"images[].name", Kind::text},
    {"images[].uri", Kind::text},
    {"images[].mimeType", Kind::text},
    {"images[].bufferView", Kind::index, "bufferViews"},
    {"extensions", Kind::object},
    {"extensions.KHR_lights_punctual", Kind::object},
    {"extensions.KHR_lights_punctual.lights", Kind::array, "", 0, kRequired},
    {"extensions.KHR_lights_punctual.lights[]", Kind::object},
    {"extensions.KHR_lights_punctual.lights[].name", Kind::text},
    {"extensions.KHR_lights_punctual.lights[].type", Kind::text, "", 0, kRequired},
    {"extensions.KHR_lights_punctual.lights[].color", Kind::numbers, "", 3},
    {"extensions.KHR_lights_punctual.lights[].intensity", Kind::number},
    {"extensions.KHR_lights_punctual.lights[].range", Kind::number},
    {"extensions.KHR_lights_punctual.lights[].spot", Kind::object},
    {"extensions.KHR_lights_punctual.lights[].spot.innerConeAngle", Kind::number},
    {"extensions.KHR_lights_punctual.lights[].spot.outerConeAngle", Kind::number},
};

class Checker {
 public:
  Checker(const json& root, const std::string& file) : root_(root), file_(file) {}

  void check(const Rule& rule) const { walk(root_, "", rule.path, rule); }

 private:
  [[noreturn]] void fail(const std::string& path, const std::string& message) const {
    gltf_fail(file_, path, message);
  }

  // Follows the first name of `rest` below `node` and what remains of it below that.
  void walk(const json& node, const std::string& path, std::string_view rest, const Rule& rule) const {
    const size_t dot = rest.find('.');
    std::string_view name = rest.substr(0, dot);
    const bool items = name.ends_with("[]"), members = name.ends_with("{}");
    if (items || members) name.remove_suffix(2);
    const std::string here = path.empty() ? std::string(name) : fmt::format("{}.{}", path, name);
    if (!node.is_object()) fail(path.empty() ? "(root)" : path, "expected an object");
    const auto it = node.find(std::string(name));
    if (it == node.end()) {
      if (dot == std::string_view::npos && rule.required) fail(here, "is missing");
      return;
    }
    const auto below = [&](const json& value, const std::string& value_path) {
      if (dot == std::string_view::npos) return judge(value, value_path, rule);
      walk(value, value_path, rest.substr(dot + 1), rule);
    };
    if (items && !it->is_array()) fail(here, "expected a list");
    if (members && !it->is_object()) fail(here, "expected an object");
    if (items)
      for (size_t i = 0; i < it->size(); ++i) below((*it)[i], fmt::format("{}[{}]", here, i));
    else if (members)
      for (const auto& [key, value] : it->items()) below(value, fmt::format("{}.{}", here, key));
    else
      below(*it, here);
  }

  void judge(const json& value, const std::string& path, const Rule& rule) const {
    const auto expect = [&](bool ok, const char* what) {
      if (!ok) fail(path, fmt::format("expected {}", what));
    };
    switch (rule.kind) {
      case Kind::object:
        return expect(value.is_object(), "an object");
      case Kind::array:
        return expect(value.is_array(), "a list");
      case Kind::text:
        return expect(value.is_string(), "a text");
      case Kind::boolean:
        return expect(value.is_boolean(), "true or false");
      case Kind::number:
        return expect(is_finite(value), "a finite number");
      case Kind::count:
        return expect(is_count(value), "a whole number from 0 to 2^31 - 1");
      case Kind::index:
        return check_index(value, path, rule.into);
      case Kind::numbers:
        expect(value.is_array() && value.size() == rule.size,
               fmt::format("a list of {} numbers", rule.size).c_str());
        return expect(std::all_of(value.begin(), value.end(), is_finite), "finite numbers");
      case Kind::indices:
        expect(value.is_array(), "a list of indices");
        for (size_t i = 0; i < value.size(); ++i)
          check_index(value[i], fmt::format("{}[{}]", path, i), rule.into);
    }
  }

  void check_index(const json& value, const std::string& path, const std::string& into) const {
    if (!is_count(value)) fail(path, fmt::format("expected an index into {}", into));
    const json* array = &root_;
    for (size_t begin = 0; begin <= into.size();) {
      const size_t end = std::min(into.find('.', begin), into.size());
      const auto it = array->is_object() ? array->find(into.substr(begin, end - begin)) : array->end();
      if (!array->is_object() || it == array->end())
        fail(path, fmt::format("points into {}, which is missing", into));
      array = &*it;
      begin = end + 1;
    }
    if (value.get<uint64_t>() >= array->size())
      fail(path, fmt::format("index {} out of range ({} {})", value.get<uint64_t>(), array->size(), into));
  }

  // Also as float, which most of them become.
  static bool is_finite(const json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= std::numeric_limits<float>::max();
  }
  static bool is_count(const json& value) {
    return value.is_number_integer() && value.get<double>() >= 0 && value.get<double>() <= 2147483647.0;
  }

  const json& root_;
  const std::string& file_;
};

/// Stops at absurd nesting, which other parsers follow by recursion.
class DepthLimit {
 public:
  bool operator()(int depth, json::parse_event_t, json&) {
    if (depth > kDeepestJson) throw InputError("nested too deeply");
    return true;
  }
};

}  // namespace

void gltf_fail(const std::string& file, const std::string& path, const std::string& message) {
  throw InputError(fmt::format("{}: {}: {}", file, path, message));
}

json parse_gltf_json(std::string_view text, const std::string& file) {
  try {
    return json::parse(text.begin(), text.end(), DepthLimit{});
  } catch (const json::exception& e) {
    throw InputError(fmt::format("{}: not valid JSON: {}", file, e.what()));
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: JSON: {}", file, e.what()));
  }
}

void check_gltf_schema(const json& root, const std::string& file) {
  if (!root.is_object()) throw InputError(file + ": expected a JSON object");
  const Checker checker(root, file);
  for (const Rule& rule : kRules) checker.check(rule);
  const auto version = root["asset"]["version"].get<std::string>();
  if (!version.starts_with("2."))
    throw InputError(fmt::format("{}: asset.version: expected 2.x, got \"{}\"", file, version));
}

}  // namespace vsslam

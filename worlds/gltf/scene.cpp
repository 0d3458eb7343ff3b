#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "worlds/gltf/extras.h"
#include "worlds/gltf/parts.h"

namespace vsslam {

namespace {

using nlohmann::json;

std::vector<double> numbers(const json& node, const char* key, std::vector<double> otherwise) {
  return node.contains(key) ? node[key].get<std::vector<double>>() : otherwise;
}

/// T_parent_node, in glTF's y-up frame.
Eigen::Affine3d local_transform(const json& node) {
  Eigen::Affine3d T_parent_node;
  if (node.contains("matrix")) {
    const auto m = numbers(node, "matrix", {});
    T_parent_node.matrix() = Eigen::Map<const Eigen::Matrix4d>(m.data());  // column-major, as glTF has it
    return T_parent_node;
  }
  const auto t = numbers(node, "translation", {0, 0, 0}), r = numbers(node, "rotation", {0, 0, 0, 1}),
             s = numbers(node, "scale", {1, 1, 1});
  return Eigen::Translation3d(t[0], t[1], t[2]) * Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized() *
         Eigen::Scaling(s[0], s[1], s[2]);
}

class SceneReader {
 public:
  SceneReader(const GltfBytes& in, World& world) : in_(in), world_(world) {
    if (!in.json.contains("nodes")) return;
    nodes_ = &in.json["nodes"];
    parent_.assign(nodes_->size(), kNoParent);
    for (size_t i = 0; i < nodes_->size(); ++i)
      for (const json& child : (*nodes_)[i].value("children", json::array())) adopt(i, child.get<size_t>());
    refuse_cycles();
  }

  // Depth first, in the order of the file.
  void read() {
    struct Visit {
      size_t node;
      Eigen::Affine3d T_root_parent;
    };
    std::vector<Visit> open;
    const auto roots = root_nodes();
    for (auto it = roots.rbegin(); it != roots.rend(); ++it)
      open.push_back({*it, Eigen::Affine3d::Identity()});
    std::vector<bool> seen(nodes_ ? nodes_->size() : 0, false);
    while (!open.empty()) {
      const Visit visit = open.back();
      open.pop_back();
      if (seen[visit.node]) fail(visit.node, "is reached twice");
      seen[visit.node] = true;
      const json& node = (*nodes_)[visit.node];
      const Eigen::Affine3d T_root_node = visit.T_root_parent * checked_transform(visit.node);
      if (!T_root_node.matrix().allFinite()) fail(visit.node, "its transform is not finite");
      place(visit.node, T_root_node);
      const json children = node.value("children", json::array());
      for (auto it = children.rbegin(); it != children.rend(); ++it)
        open.push_back({it->get<size_t>(), T_root_node});
    }
  }

 private:
  static constexpr size_t kNoParent = ~size_t{0};

  [[noreturn]] void fail(size_t node, const std::string& message) const {
    gltf_fail(in_.file, fmt::format("nodes[{}]", node), message);
  }

  void adopt(size_t parent, size_t child) {
    if (parent_[child] != kNoParent)
      fail(child, fmt::format("has two parents, nodes[{}] and nodes[{}]", parent_[child], parent));
    parent_[child] = parent;
  }

  // With one parent at most, a cycle is a way up that comes back to where it has been.
  void refuse_cycles() const {
    std::vector<size_t> walk_of(parent_.size(), kNoParent);
    for (size_t start = 0; start < parent_.size(); ++start)
      for (size_t i = start; i != kNoParent; i = parent_[i]) {
        if (walk_of[i] == start) fail(i, "is its own ancestor");
        if (walk_of[i] != kNoParent) break;
        walk_of[i] = start;
      }
  }

  // The scene's nodes, or without scenes all nodes that have no parent.
  std::vector<size_t> root_nodes() const {
    std::vector<size_t> roots;
    if (!nodes_) return roots;
    if (in_.json.contains("scenes") && !in_.json["scenes"].empty()) {
      const json& scene = in_.json["scenes"][in_.json.value("scene", size_t{0})];
      for (const json& node : scene.value("nodes", json::array())) {
        roots.push_back(node.get<size_t>());
        if (parent_[roots.back()] != kNoParent) fail(roots.back(), "is a scene's root but has a parent");
      }
      return roots;
    }
    for (size_t i = 0; i < parent_.size(); ++i)
      if (parent_[i] == kNoParent) roots.push_back(i);
    return roots;
  }

  Eigen::Affine3d checked_transform(size_t index) const {
    const json& node = (*nodes_)[index];
    if (node.contains("matrix")) {
      const auto m = numbers(node, "matrix", {});
      if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) fail(index, "its matrix is not affine");
    }
    const auto r = numbers(node, "rotation", {0, 0, 0, 1});
    if (!(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3] > 1e-12)) fail(index, "its rotation is zero");
    return local_transform(node);
  }

  void place(size_t index, const Eigen::Affine3d& T_root_node) {
    const json& node = (*nodes_)[index];
    const GltfExtras extras(node, fmt::format("nodes[{}]", index), in_.file);
    if (node.contains("mesh")) place_object(index, extras, T_root_node);
    if (!node.contains("extensions") || !node["extensions"].contains("KHR_lights_punctual")) return;
    Light light = read_light(in_, node["extensions"]["KHR_lights_punctual"]["light"].get<size_t>());
    if (node.contains("name")) light.name = node["name"].get<std::string>();
    light.group = "lamp";
    extras.get("light_group", light.group);
    extras.get("light_radius_m", light.radius_m);
    if (light.radius_m < 0) extras.fail("light_radius_m", "expected 0 or more");
    light.position_world = vsslam::z_up(Vec3(T_root_node.translation()));
    const Vec3 along = vsslam::z_up(Vec3(-T_root_node.linear().col(2)));
    const double length = along.norm();
    if (!(length > 1e-12)) fail(index, "its light has no direction");
    light.direction_world = std::abs(length - 1) < 1e-12 ? along : Vec3(along / length);
    world_.lights.push_back(light);
  }

  void place_object(size_t index, const GltfExtras& extras, const Eigen::Affine3d& T_root_node) {
    const json& node = (*nodes_)[index];
    int mesh = node["mesh"].get<int>();
    if (world_.meshes[static_cast<size_t>(mesh)].primitives.empty()) return;
    if (T_root_node.linear().determinant() < 0) mesh = mirrored(mesh);
    std::string collision = "mesh";
    extras.get("collision", collision);
    if (collision != "mesh" && collision != "none") extras.fail("collision", "expected \"mesh\" or \"none\"");
    check_extent(index, world_.meshes[static_cast<size_t>(mesh)], T_root_node);
    Object object{.name = node.value("name", ""), .mesh = mesh};
    if (object.name.empty()) object.name = fmt::format("object_{}", index);
    object.T_world_object = z_up(T_root_node);
    object.collision = collision == "none" ? Collision::none : Collision::mesh;
    world_.objects.push_back(std::move(object));
  }

  void check_extent(size_t index, const Mesh& mesh, const Eigen::Affine3d& T_root_node) const {
    constexpr double kFarthest_m = 1e7;  // float coordinates beyond that are metres apart
    double reach_m = 0;
    for (const Primitive& primitive : mesh.primitives)
      for (const Vec3f& p : primitive.positions) reach_m = std::max<double>(reach_m, p.cwiseAbs().maxCoeff());
    reach_m = 3 * T_root_node.linear().cwiseAbs().maxCoeff() * reach_m;
    if (!(reach_m + T_root_node.translation().cwiseAbs().maxCoeff() < kFarthest_m))
      fail(index, fmt::format("its mesh reaches beyond {} m", kFarthest_m));
  }

  // A mirroring transform turns triangles inside out: such objects get a mesh wound the other way.
  int mirrored(int mesh) {
    const auto [it, added] = mirrored_.emplace(mesh, static_cast<int>(world_.meshes.size()));
    if (!added) return it->second;
    Mesh copy = world_.meshes[static_cast<size_t>(mesh)];
    copy.name += "_mirrored";
    for (Primitive& primitive : copy.primitives)
      for (auto& t : primitive.triangles) std::swap(t[1], t[2]);
    world_.meshes.push_back(std::move(copy));
    return it->second;
  }

  const GltfBytes& in_;
  World& world_;
  const json* nodes_ = nullptr;
  std::vector<size_t> parent_;
  std::map<int, int> mirrored_;
};

void read_floor(const GltfExtras& extras, const std::string& file, const std::string& path, Floor& floor) {
  if (!extras.has("floor")) return;
  const json owner = {{"extras", {{kGltfExtras, extras.at("floor")}}}};
  const GltfExtras values(owner, path + ".floor", file);
  values.get("height_m", floor.height_m);
  values.get("unevenness_m", floor.unevenness_m);
  values.get("wavelength_m", floor.wavelength_m);
  if (floor.unevenness_m < 0) values.fail("unevenness_m", "expected 0 or more");
  if (!(floor.wavelength_m > 0)) values.fail("wavelength_m", "expected more than 0");
  std::string seed = std::to_string(floor.seed);
  values.get("seed", seed);
  const auto [end, error] = std::from_chars(seed.data(), seed.data() + seed.size(), floor.seed);
  if (error != std::errc() || end != seed.data() + seed.size())
    values.fail("seed", "expected a whole number in quotes");
}

void read_routes(const GltfExtras& extras, World& world) {
  if (!extras.has("routes")) return;
  const auto expect = [&](bool ok, const std::string& message) {
    if (!ok) extras.fail("routes", message);
  };
  expect(extras.at("routes").is_array(), "expected a list");
  for (const json& source : extras.at("routes")) {
    expect(source.is_object() && source.contains("name") && source["name"].is_string(),
           "expected routes with names");
    Route route{.name = source["name"].get<std::string>(), .closed = false, .points_world = {}};
    if (source.contains("closed")) {
      expect(source["closed"].is_boolean(), route.name + ": closed: expected true or false");
      route.closed = source["closed"].get<bool>();
    }
    const json points = source.value("points_world", json::array());
    expect(points.is_array(), route.name + ": points_world: expected a list");
    for (const json& point : points) {
      expect(point.is_array() && point.size() == 3, route.name + ": expected points of three numbers");
      Vec3 p;
      for (size_t i = 0; i < 3; ++i) {
        expect(point[i].is_number() && std::isfinite(point[i].get<double>()),
               route.name + ": expected finite numbers");
        p[static_cast<int>(i)] = point[i].get<double>();
      }
      route.points_world.push_back(p);
    }
    world.routes.push_back(std::move(route));
  }
}

}  // namespace

void read_scene(const GltfBytes& in, World& world) {
  SceneReader(in, world).read();
  if (!in.json.contains("scenes") || in.json["scenes"].empty()) return;
  const size_t index = in.json.value("scene", size_t{0});
  const json& scene = in.json["scenes"][index];
  const std::string path = fmt::format("scenes[{}]", index);
  if (scene.contains("name")) world.name = scene["name"].get<std::string>();
  const GltfExtras extras(scene, path, in.file);
  read_floor(extras, in.file, path, world.floor);
  read_routes(extras, world);
}

}  // namespace vsslam

#include "worlds/indoor/furniture.h"

#include <array>

namespace vsslam {

namespace {

constexpr std::array<const char*, kFurnitureKinds> kNames = {"box",      "boxes", "bench", "plant",
                                                             "cupboard", "table", "bin",   "round_pillar"};

void build_table(MeshBuilder& b, const IndoorPalette& p, const Vec3& size) {
  b.box(p.wood, {0, 0, size.z() - 0.04}, {size.x(), size.y(), 0.04});
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      b.box(p.metal, {x * (size.x() / 2 - 0.06), y * (size.y() / 2 - 0.06), 0},
            {0.05, 0.05, size.z() - 0.04});
}

void build_bench(MeshBuilder& b, const IndoorPalette& p, const Vec3& size) {
  b.box(p.fabric, {0.04, 0, 0.38}, {size.x() - 0.08, size.y(), 0.07});
  b.box(p.fabric, {-size.x() / 2 + 0.04, 0, 0.38}, {0.08, size.y(), size.z() - 0.38});
  for (const double y : {-1.0, 1.0})
    b.box(p.metal, {0.02, y * (size.y() / 2 - 0.15), 0}, {size.x() - 0.1, 0.05, 0.38});
}

void build_plant(MeshBuilder& b, const IndoorPalette& p, const Vec3& size) {
  b.cylinder(p.pot, {0, 0, 0}, 0.16, 0.21, 0.38, 16);
  b.cylinder(p.wood, {0, 0, 0.38}, 0.02, 0.015, 0.5, 8);
  b.ball(p.foliage, {0, 0, size.z() - 0.36}, 0.24, 7, 0.35, 1);
  b.ball(p.foliage, {0.07, 0.05, size.z() - 0.6}, 0.19, 6, 0.4, 2);
  b.ball(p.foliage, {-0.06, -0.08, size.z() - 0.55}, 0.18, 6, 0.4, 3);
}

}  // namespace

Vec3 furniture_size_m(FurnitureKind kind) {
  switch (kind) {
    case FurnitureKind::box:
      return {0.4, 0.5, 0.45};
    case FurnitureKind::boxes:
      return {0.5, 0.6, 0.95};
    case FurnitureKind::bench:
      return {0.5, 1.6, 0.85};
    case FurnitureKind::plant:
      return {0.5, 0.5, 1.4};
    case FurnitureKind::cupboard:
      return {0.45, 1.0, 1.9};
    case FurnitureKind::table:
      return {0.8, 1.4, 0.74};
    case FurnitureKind::bin:
      return {0.36, 0.36, 0.7};
    case FurnitureKind::round_pillar:
      return {0.4, 0.4, 2.95};
  }
  return Vec3::Zero();
}

Mesh make_furniture(FurnitureKind kind, const IndoorPalette& p, double ceiling_m) {
  const Vec3 size = furniture_size_m(kind), foot = Vec3::Zero();
  MeshBuilder b;
  switch (kind) {
    case FurnitureKind::box:
      b.box(p.cardboard, foot, size);
      break;
    case FurnitureKind::boxes:
      b.box(p.cardboard, foot, {0.5, 0.6, 0.55});
      b.box(p.cardboard, {-0.04, 0.06, 0.55}, {0.36, 0.42, 0.4});
      break;
    case FurnitureKind::bench:
      build_bench(b, p, size);
      break;
    case FurnitureKind::plant:
      build_plant(b, p, size);
      break;
    case FurnitureKind::cupboard:
      b.box(p.metal, foot, {size.x() - 0.05, size.y() - 0.04, 0.08});
      b.box(p.wood, {0, 0, 0.08}, {size.x(), size.y(), size.z() - 0.08});
      break;
    case FurnitureKind::table:
      build_table(b, p, size);
      break;
    case FurnitureKind::bin:
      b.cylinder(p.metal, foot, 0.15, 0.18, size.z(), 20);
      break;
    case FurnitureKind::round_pillar:
      b.cylinder(p.pillar.material, foot, 0.2, 0.2, ceiling_m + 0.05, 32, 1 / p.pillar.width_m);
      break;
  }
  return b.finish(kNames[static_cast<size_t>(kind)]);
}

void Furnisher::place(FurnitureKind kind, const Vec3& foot_world, double heading_rad) {
  const auto k = static_cast<size_t>(kind);
  if (mesh_of_kind_[k] < 0) {
    mesh_of_kind_[k] = static_cast<int>(world_.meshes.size());
    world_.meshes.push_back(make_furniture(kind, palette_, ceiling_m_));
  }
  Object object{.name = kNames[k] + std::string("_") + std::to_string(++pieces_[k]),
                .mesh = mesh_of_kind_[k]};
  object.T_world_object = Eigen::Translation3d(foot_world) * Eigen::AngleAxisd(heading_rad, Vec3::UnitZ());
  world_.objects.push_back(std::move(object));
}

}  // namespace vsslam
